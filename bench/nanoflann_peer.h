#pragma once

#include "bench/radius_clusters.h"

namespace sunder::bench {

struct NanoflannClusters {
  RadiusClusters clusters;
  double build = 0, search = 0;  ///< Seconds: of the tree, and of all else.
};

/// The clusters of cluster_by_scan() by nanoflann's k-d tree. Built where nanoflann is.
[[nodiscard]] NanoflannClusters cluster_by_nanoflann(std::span<const Vec3f> points, float radius);

}  // namespace sunder::bench
