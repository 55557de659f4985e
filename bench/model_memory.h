#pragma once

#include "bench/tear_scene.h"

namespace sunder::bench {

/// Bytes per point that a torn model uses in addition to its copy of the character, after a first
/// tear, as counted by malloc.
struct BytesPerPoint {
  double model = 0;         ///< Connectivity, search structures for faces, births, data for undo.
  double posed_points = 0;  ///< Positions of the points in the pose.
};
[[nodiscard]] BytesPerPoint bytes_per_point(const Scene& scene);

}  // namespace sunder::bench
