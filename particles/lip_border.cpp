#include "particles/lip_border.h"

namespace sunder::particles {

Index LipBorder::leaving(Index point) const {
  const Index start = surface_.point_corner[point];
  if (start == kNone) return kNone;
  const Index first = surface_.first_of_fan(start);
  Index corner = first;
  do {
    if (has(corner)) return corner;
    corner = surface_.rotate_ccw(corner);
  } while (corner != kNone && corner != first);
  return kNone;
}

Index LipBorder::arriving(Index point) const {
  const Index start = surface_.point_corner[point];
  if (start == kNone) return kNone;
  const Index first = surface_.first_of_fan(start);
  Index corner = first;
  do {
    if (has(Surface::previous(corner))) return Surface::previous(corner);
    corner = surface_.rotate_ccw(corner);
  } while (corner != kNone && corner != first);
  return kNone;
}

}  // namespace sunder::particles
