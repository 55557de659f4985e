#pragma once

#include "bench/tear_scene.h"

namespace sunder::bench {

/// Bytes a point that a torn model holds beyond its copy of the character, after a first tear, as
/// malloc counts them.
struct BytesPerPoint {
  double model = 0;         ///< Connectivity, what finds faces, births, what undo needs.
  double posed_points = 0;  ///< The places of points in the pose.
};
[[nodiscard]] BytesPerPoint bytes_per_point(const Scene& scene);

}  // namespace sunder::bench
