#pragma once

#include "bench/skinning/skinning_scene.h"

namespace sunder::bench {

/// The nanoseconds per vertex by which posing takes longer if every vertex is displaced.
struct Displacing {
  double positions = 0, normals = 0, tangents = 0;  ///< Each together with those before.
};

[[nodiscard]] Displacing measure_displacing(const SkinningScene& scene);

}  // namespace sunder::bench
