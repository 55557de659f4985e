#pragma once

#include <sunder/core/mesh.h>

#include <span>

namespace sunder::tear {

/// The displacement of a vertex by the morph targets of its mesh, in bind space.
/// @param morph_weights  all weights of the pose.
inline Vec3d morph_displacement(const Mesh& mesh, std::uint32_t vertex,
                                std::span<const float> morph_weights) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t j = 0; j < mesh.morph_targets.size(); ++j)
    if (!mesh.morph_targets[j].position_deltas.empty())
      sum += static_cast<double>(morph_weights[mesh.first_morph_weight + j]) *
             mesh.morph_targets[j].position_deltas[vertex].cast<double>();
  return sum;
}

}  // namespace sunder::tear
