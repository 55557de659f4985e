#include "particles/surface_front.h"

namespace sunder::particles {

void RingWalk::append_ring(const Surface& surface, std::span<const Vec3f> positions, Index point, std::vector<RingPoint>& ring) {
  const Index start = surface.point_corner[point];
  if (start == kNone) return;
  const Vec3f at = positions[point];
  const auto add = [&](Index other) {
    if (other >= positions.size()) return;  // it came since
    const Vec3f& to = positions[other];
    const float x = to.x() - at.x(), y = to.y() - at.y(), z = to.z() - at.z();
    ring.push_back({other, std::sqrt(x * x + y * y + z * z)});
  };
  const auto walk = [&](Index first) {
    add(surface.corner_point[Surface::next(first)]);
    Index corner = first;
    do {
      const Index back = Surface::previous(corner);
      add(surface.corner_point[back]);
      corner = surface.twin[back];
    } while (corner != kNone && corner != first);
    return corner != kNone;
  };
  const std::size_t size = ring.size();
  if (walk(start)) return;
  const Index first = surface.first_of_fan(start);
  if (first == start) return;
  ring.resize(size);  // it is open, and began in the middle
  walk(first);
}

Rings::Rings(const Surface& surface, std::span<const Vec3f> positions) {
  first_.reserve(surface.point_count() + 1);
  points_.reserve(surface.corner_point.size() + surface.corner_point.size() / 4 + 64);
  for (Index point = 0; point < surface.point_count(); ++point) {
    first_.push_back(static_cast<Index>(points_.size()));
    RingWalk::append_ring(surface, positions, point, points_);
  }
  first_.push_back(static_cast<Index>(points_.size()));
}

}  // namespace sunder::particles
