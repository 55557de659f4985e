#pragma once

#include "bench/skinning/skinning_scene.h"

namespace sunder::bench {

/// What displacing every vertex adds to posing it: nanoseconds per vertex.
struct Displacing {
  double positions = 0, normals = 0, tangents = 0;  ///< Each together with those before.
};

[[nodiscard]] Displacing measure_displacing(const SkinningScene& scene);

}  // namespace sunder::bench
