#include "tear/path/edge_crossing.h"

#include <algorithm>

#include "tear/internal/surface.h"

namespace sunder::tear {

SurfaceHit EdgeCrossing::place() const {
  SurfaceHit hit{half_edge / 3, {}, position, 0};
  hit.barycentric[half_edge % 3] = 1 - fraction;
  hit.barycentric[Surface::next(half_edge) % 3] = fraction;
  return hit;
}

EdgeCrossing cross_edge(const BladePlane& plane, Index half_edge, const SurfaceEditor& editor,
                        PosedPoints& posed) {
  const auto& points = editor.surface().corner_point;
  const Vec3d from = posed.position(editor, points[half_edge]);
  const Vec3d to = posed.position(editor, points[Surface::next(half_edge)]);
  const double at_from = plane.distance(from), at_to = plane.distance(to);
  const double fraction =
      at_from == at_to ? 0.0 : std::clamp(at_from / (at_from - at_to), 0.0, 1.0);
  return {half_edge, fraction, from + fraction * (to - from)};
}

EdgeCrossing find_exit(const BladePlane& plane, Index half_edge, const SurfaceEditor& editor,
                       PosedPoints& posed) {
  const auto& points = editor.surface().corner_point;
  const auto is_left = [&](Index corner) {
    return plane.distance(posed.position(editor, points[corner])) >= 0;
  };
  const Index opposite = Surface::previous(half_edge);
  return cross_edge(plane,
                    is_left(opposite) == is_left(half_edge) ? Surface::next(half_edge) : opposite,
                    editor, posed);
}

SurfaceHit place_between(const SurfaceHit& from, const SurfaceHit& to, double fraction) {
  SurfaceHit hit{to.triangle, {}, from.position + fraction * (to.position - from.position), 0};
  for (std::size_t k = 0; k < 3; ++k)
    hit.barycentric[k] = (1 - fraction) * from.barycentric[k] + fraction * to.barycentric[k];
  return hit;
}

}  // namespace sunder::tear
