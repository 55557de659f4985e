#include "tear/path/imprint_point.h"

#include <algorithm>

#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/surface/split.h"

namespace sunder::tear {

Index split_posed_edge(Index half_edge, double fraction, SurfaceEditor& editor,
                       PosedPoints& posed) {
  const auto& points = editor.surface().corner_point;
  const Vec3d from = posed.position(editor, points[half_edge]);
  const Vec3d to = posed.position(editor, points[Surface::next(half_edge)]);
  const Index point = split_edge(half_edge, fraction, editor);
  if (point != kNone) posed.pin(point, from + fraction * (to - from));
  return point;
}

Index imprint_point(const SurfaceHit& hit, Snapping snapping, SurfaceEditor& editor,
                    PosedPoints& posed) {
  const Index first = 3 * hit.triangle;
  std::array<double, 3> weight = hit.barycentric;
  double sum = 0;
  for (Index k = 0; k < 3; ++k) {
    if (weight[k] < snapped_height(first + k, snapping, editor, posed)) weight[k] = 0;
    sum += weight[k];
  }
  for (double& w : weight) w /= sum;
  const auto largest =
      static_cast<Index>(std::max_element(weight.begin(), weight.end()) - weight.begin());
  const auto smallest =
      static_cast<Index>(std::min_element(weight.begin(), weight.end()) - weight.begin());
  if (weight[largest] == 1 || is_at_lip_corner(hit, first + largest, snapping, editor, posed))
    return editor.surface().corner_point[first + largest];

  if (weight[smallest] > 0) {
    const Index point = split_triangle(hit.triangle, weight, editor);
    if (point != kNone) {
      posed.pin(point, hit.position);
      return point;
    }
  }
  // On the edge opposite of the smallest coordinate, or as near to it as the face allows.
  const Index edge = Surface::next(first + smallest);
  const double along =
      weight[Surface::next(edge) % 3] / (weight[edge % 3] + weight[Surface::next(edge) % 3]);
  const double snap = snapped_part(edge, snapping, editor, posed);
  if (along > snap && along < 1 - snap)
    if (const Index point = split_posed_edge(edge, along, editor, posed); point != kNone)
      return point;
  return editor.surface().corner_point[along < 0.5 ? edge : Surface::next(edge)];
}

}  // namespace sunder::tear
