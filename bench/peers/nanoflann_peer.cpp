#include "bench/peers/nanoflann_peer.h"

#include <nanoflann.hpp>
#include <optional>
#include <utility>

#include "bench/harness/measure.h"

namespace sunder::bench {
namespace {

/// The interface through which nanoflann reads points.
struct Cloud {
  std::span<const Vec3f> points;

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t point, std::size_t axis) const {
    return points[point][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;  // to be computed
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud,
                                                 3, std::uint32_t>;

}  // namespace

NanoflannClusters cluster_by_nanoflann(std::span<const Vec3f> points, float radius) {
  NanoflannClusters result;
  const Cloud cloud = {points};
  std::optional<Tree> tree;
  result.build = seconds_of([&] {
    tree.emplace(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    tree->buildIndex();
  });
  std::vector<std::pair<std::uint32_t, float>> found;
  const nanoflann::SearchParams unsorted(32, 0.0f, false);
  result.search = seconds_of([&] {
    result.clusters = cluster_by_radius(
        points.size(), [&](std::uint32_t centre, std::vector<std::uint32_t>& members) {
          tree->radiusSearch(points[centre].data(), radius * radius, found, unsorted);
          for (const auto& [point, squared_distance] : found) members.push_back(point);
        });
  });
  return result;
}

}  // namespace sunder::bench
