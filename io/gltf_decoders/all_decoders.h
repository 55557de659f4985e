#pragma once

#include "io/gltf/decoders.h"

namespace sunder::gltf {

/// By simdjson, meshoptimizer and Draco.
[[nodiscard]] const Decoders& all_decoders();

}  // namespace sunder::gltf
