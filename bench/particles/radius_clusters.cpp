#include "bench/particles/radius_clusters.h"

namespace sunder::bench {

RadiusClusters cluster_by_scan(std::span<const Vec3f> points, float radius) {
  const auto count = static_cast<Eigen::Index>(points.size());
  // One array per coordinate, so that Eigen's vectors are full.
  const Eigen::Array<float, Eigen::Dynamic, 3> places =
      Eigen::Map<const Eigen::Array<float, Eigen::Dynamic, 3, Eigen::RowMajor>>(
          count == 0 ? nullptr : points[0].data(), count, 3);
  Eigen::ArrayXf squared_distances(count);
  return cluster_by_radius(points.size(), [&](std::uint32_t centre,
                                              std::vector<std::uint32_t>& members) {
    const Vec3f& place = points[centre];
    squared_distances = (places.col(0) - place.x()).square() +
                        (places.col(1) - place.y()).square() + (places.col(2) - place.z()).square();
    for (Eigen::Index i = 0; i < count; ++i)
      if (squared_distances[i] < radius * radius) members.push_back(static_cast<std::uint32_t>(i));
  });
}

}  // namespace sunder::bench
