#include "bench/radius_clusters.h"

namespace sunder::bench {

RadiusClusters cluster_by_scan(std::span<const Vec3f> points, float radius) {
  using Coordinates = Eigen::Map<const Eigen::Matrix<float, 3, Eigen::Dynamic>>;
  const Coordinates places(points.empty() ? nullptr : points[0].data(), 3, static_cast<Eigen::Index>(points.size()));
  Eigen::RowVectorXf squared_distances(places.cols());
  return cluster_by_radius(points.size(), [&](std::uint32_t centre, std::vector<std::uint32_t>& members) {
    squared_distances.noalias() = (places.colwise() - Eigen::Vector3f(points[centre])).colwise().squaredNorm();
    for (Eigen::Index i = 0; i < squared_distances.size(); ++i)
      if (squared_distances[i] < radius * radius) members.push_back(static_cast<std::uint32_t>(i));
  });
}

}  // namespace sunder::bench
