#pragma once

#include <sunder/core/skin.h>

#include <cstddef>
#include <cstdint>
#include <numeric>

namespace sunder::gltf {

/// Weights of vertices that all follow the first bone of their skin.
[[nodiscard]] inline SkinWeights rigid_weights(std::uint32_t vertex_count) {
  SkinWeights weights;
  weights.first.resize(std::size_t{vertex_count} + 1);
  std::iota(weights.first.begin(), weights.first.end(), 0u);
  weights.influences.assign(vertex_count, {0, 1.0f});
  return weights;
}

}  // namespace sunder::gltf
