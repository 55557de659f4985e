#pragma once

#include "bench/tear/tear_scene.h"

namespace sunder::bench {

/// Bytes per point that a torn model uses in addition to its copy of the character, after a first
/// tear, as counted by malloc.
struct BytesPerPoint {
  double model = 0;         ///< Connectivity, search structures for faces, births, data for undo.
  double posed_points = 0;  ///< Positions of the points in the pose.
};
[[nodiscard]] BytesPerPoint bytes_per_point(const Scene& scene);

/// The memory of models of one asset, as counted by malloc.
struct InstanceCosts {
  double untouched_bytes = 0;
  double packed_bytes_per_vertex = 0;  ///< Per new vertex, after one tear; with its pose.
  double capacity_bytes_per_vertex = 0, capacity_bytes_per_operation = 0;
  double us_create = 0, us_pack = 0, us_unpack = 0;
};
[[nodiscard]] InstanceCosts instance_costs(const Scene& scene);

}  // namespace sunder::bench
