#pragma once

#include <sunder/core/mesh.h>

#include <cmath>
#include <span>

namespace sunder::skinning {

/// sum_k w_k M_k of one vertex. Built from a loop of multiply-adds, so that it vectorises and its order is fixed.
template <class Scalar, class Palette>
Eigen::Matrix<Scalar, 3, 4> blend_matrix(std::span<const Influence> influences, const Palette& model_from_bind) {
  using Numbers = Eigen::Array<Scalar, 12, 1>;  // a matrix as what it is in memory: whole packets, where three rows are none
  Numbers sum = Numbers::Zero();
  for (const Influence& influence : influences)
    sum += static_cast<Scalar>(influence.weight) * Eigen::Map<const Numbers>(model_from_bind[influence.slot].data());
  return Eigen::Map<const Eigen::Matrix<Scalar, 3, 4>>(sum.data());
}

/// A bind-space attribute plus its morph deltas: `get(target)` is the array of deltas or an empty one.
template <class Scalar, class Deltas>
Eigen::Matrix<Scalar, 3, 1> add_morphs(const Mesh& mesh, std::uint32_t vertex, std::span<const float> morph_weights,
                                       Eigen::Matrix<Scalar, 3, 1> value, Deltas deltas) {
  for (std::size_t j = 0; j < mesh.morph_targets.size(); ++j) {
    const auto& of_target = mesh.morph_targets[j].*deltas;
    const float weight = morph_weights[mesh.first_morph_weight + j];
    if (weight != 0.0f && !of_target.empty()) value += static_cast<Scalar>(weight) * of_target[vertex].template cast<Scalar>();
  }
  return value;
}

/// `direction` made unit length, or `fallback` where it has none.
template <class Scalar>
Eigen::Matrix<Scalar, 3, 1> unit_or(const Eigen::Matrix<Scalar, 3, 1>& direction, const Eigen::Matrix<Scalar, 3, 1>& fallback) {
  const Scalar largest = direction.cwiseAbs().maxCoeff();
  if (!(largest > Scalar(0)) || !std::isfinite(largest)) return fallback;
  const Eigen::Matrix<Scalar, 3, 1> scaled = direction / largest;  // squares of small numbers underflow
  return scaled / scaled.norm();
}

}  // namespace sunder::skinning
