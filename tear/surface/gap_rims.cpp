#include "tear/surface/gap_rims.h"

#include "tear/internal/surface.h"
#include "tear/surface/sort_by_index.h"

namespace sunder::tear {

ScratchVector<std::uint64_t> sort_rim_points(std::span<const RimPoint> points,
                                             ScratchMemory& memory) {
  ScratchVector<std::uint64_t> sorted(&memory);
  sorted.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    sorted.push_back(std::uint64_t{points[i].point} << 32 | i << 1 | (points[i].is_left ? 1u : 0u));
  // Those of one point are in order already, and stay so.
  sort_by_index(
      sorted, [](std::uint64_t point) { return static_cast<Index>(point >> 32); }, memory);
  return sorted;
}

void settle_rims(std::span<const std::uint64_t> sorted, const Surface& surface, Rims& rims) {
  rims.left.clear();
  rims.right.clear();
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const auto point = static_cast<Index>(sorted[i] >> 32);
    if (i + 1 < sorted.size() && sorted[i + 1] >> 32 == point) continue;
    if (surface.point_corner[point] != kNone)
      ((sorted[i] & 1) != 0 ? rims.left : rims.right).push_back(point);
  }
}

}  // namespace sunder::tear
