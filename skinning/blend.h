#pragma once

#include <sunder/core/mesh.h>

#include <cmath>
#include <span>

#include "core/internal/ordered.h"

namespace sunder::skinning {

/// sum_k w_k M_k of one vertex, in double.
inline Eigen::Matrix<double, 3, 4> blend_matrix(std::span<const Influence> influences,
                                                std::span<const Affine3d> model_from_bind) {
  // A matrix as 12 consecutive numbers, which fill whole packets; columns of three do not.
  using Numbers = Eigen::Array<double, 12, 1>;
  Numbers sum = Numbers::Zero();
  for (const Influence& influence : influences)
    sum += static_cast<double>(influence.weight) *
           Eigen::Map<const Numbers>(model_from_bind[influence.slot].data());
  return Eigen::Map<const Eigen::Matrix<double, 3, 4>>(sum.data());
}

/// A bind-space attribute plus the displacements of the morph targets. @param deltas  member of
/// MorphTarget; an empty array displaces nothing.
template <class Deltas>
Eigen::Vector3d add_morphs(const Mesh& mesh, std::uint32_t vertex,
                           std::span<const float> morph_weights, Eigen::Vector3d value,
                           Deltas deltas) {
  for (std::size_t j = 0; j < mesh.morph_targets.size(); ++j) {
    const auto& of_target = mesh.morph_targets[j].*deltas;
    const float weight = morph_weights[mesh.first_morph_weight + j];
    if (weight != 0.0f && !of_target.empty())
      value += static_cast<double>(weight) * of_target[vertex].template cast<double>();
  }
  return value;
}

/// `direction` scaled to unit length, or `fallback` if it has no length.
inline Eigen::Vector3d unit_or(const Eigen::Vector3d& direction, const Eigen::Vector3d& fallback) {
  const double largest = direction.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !std::isfinite(largest)) return fallback;
  const Eigen::Vector3d scaled = direction / largest;  // squares of small numbers underflow
  return scaled / norm(scaled);
}

}  // namespace sunder::skinning
