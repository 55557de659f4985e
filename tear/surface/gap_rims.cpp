#include "tear/surface/gap_rims.h"

#include <algorithm>

#include "tear/internal/surface.h"

namespace sunder::tear {

void settle_rims(std::vector<RimPoint>& points, const Surface& surface, Rims& rims) {
  rims.left.clear();
  rims.right.clear();
  if (points.empty()) return;
  std::stable_sort(points.begin(), points.end(),
                   [](const RimPoint& a, const RimPoint& b) { return a.point < b.point; });
  for (std::size_t i = 0; i < points.size(); ++i) {
    const RimPoint& last = points[i];
    if (i + 1 < points.size() && points[i + 1].point == last.point) continue;
    if (surface.point_corner[last.point] != kNone)
      (last.is_left ? rims.left : rims.right).push_back(last.point);
  }
}

}  // namespace sunder::tear
