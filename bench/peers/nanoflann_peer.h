#pragma once

#include "bench/particles/radius_clusters.h"

namespace sunder::bench {

struct NanoflannClusters {
  RadiusClusters clusters;
  double build = 0, search = 0;  ///< Seconds: for the tree, and for the rest.
};

/// The clusters of cluster_by_scan(), found by nanoflann's k-d tree. Built if nanoflann is found.
[[nodiscard]] NanoflannClusters cluster_by_nanoflann(std::span<const Vec3f> points, float radius);

}  // namespace sunder::bench
