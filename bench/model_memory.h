#pragma once

#include "bench/tear_scene.h"

namespace sunder::bench {

/// Bytes a point that a torn model holds beyond its copy of the character, after a first tear: connectivity, whatever finds faces,
/// births, posed points, what undo needs. As malloc counts them.
[[nodiscard]] double bytes_per_point(const Scene& scene);

}  // namespace sunder::bench
