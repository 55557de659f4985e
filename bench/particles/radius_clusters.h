#pragma once

#include <sunder/core/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace sunder::bench {

/// Overlapping clusters of points by straight-line distance: the first point that is in no cluster
/// becomes a centre, and all points within the radius form its cluster.
struct RadiusClusters {
  std::vector<std::uint32_t> centres;
  /// Per cluster the offset of its first entry in `members`; the total at the end.
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> members;  ///< In any order.
};

/// @param search  search(centre, members) appends the points within the radius of a centre.
template <class Search>
RadiusClusters cluster_by_radius(std::size_t points, Search&& search) {
  RadiusClusters clusters;
  std::vector<bool> is_covered(points, false);
  for (std::uint32_t point = 0; point < points; ++point) {
    if (is_covered[point]) continue;
    clusters.centres.push_back(point);
    clusters.first.push_back(static_cast<std::uint32_t>(clusters.members.size()));
    search(point, clusters.members);
    for (std::size_t i = clusters.first.back(); i < clusters.members.size(); ++i)
      is_covered[clusters.members[i]] = true;
  }
  clusters.first.push_back(static_cast<std::uint32_t>(clusters.members.size()));
  return clusters;
}

/// Baseline: distances of all points to each centre, by Eigen.
[[nodiscard]] RadiusClusters cluster_by_scan(std::span<const Vec3f> points, float radius);

}  // namespace sunder::bench
