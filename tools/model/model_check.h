#pragma once

#include <sunder/core/character.h>

namespace sunder::tools {

/// Extremes and faults of the numbers of a model, over all vertices of all meshes.
struct ModelCheck {
  double least_weight_sum = 1.0;
  double greatest_weight_sum = 1.0;
  double greatest_weight_sum_error = 0.0;  ///< |sum - 1|.
  double least_weight = 1.0;
  std::uint32_t most_influences = 0;
  /// In positions, normals, tangents, texture coordinates, colours, morph deltas and weights.
  std::uint64_t non_finite_values = 0;
};

[[nodiscard]] ModelCheck check_mesh(const Mesh& mesh);
[[nodiscard]] ModelCheck check_model(const Character& character);

/// Whether nothing bends a model: it has no clip, and no skin of several bones.
[[nodiscard]] bool is_static(const Character& character);

}  // namespace sunder::tools
