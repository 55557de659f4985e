#pragma once

#include <sunder/operation/pose_spec.h>

#include <cstdint>

namespace sunder {

/// How a point that an operation creates is skinned. See docs/weights.md.
enum class WeightPolicy : std::uint8_t {
  /// Bind position and weights are interpolated from the triangle's corners. The point leaves the
  /// untorn surface where bones turn apart.
  barycentric,
  /// As `barycentric`, but with a bind position that is exact in the pose of the operation.
  pose_exact,
  /// Weights and bind position are fitted over many poses, in the background; `barycentric` until
  /// then.
  refit,
  /// One bind position per influence, exact in every pose. See TornModel::influence_positions().
  exact,
};

/// The enumerator's name as text, as used in logs and by the command.
[[nodiscard]] constexpr const char* weight_policy_name(WeightPolicy policy) {
  switch (policy) {
    case WeightPolicy::barycentric: return "barycentric";
    case WeightPolicy::pose_exact: return "pose_exact";
    case WeightPolicy::refit: return "refit";
    case WeightPolicy::exact: return "exact";
  }
  return "unknown";
}

struct WeightOptions {
  WeightPolicy policy = WeightPolicy::barycentric;
  /// Influences kept per new point: the largest ones, renormalised. 0: all. `exact` keeps all.
  std::uint32_t maximum_influences = 0;

  bool operator==(const WeightOptions&) const = default;
};

/// How the policy `refit` fits weights.
struct RefitOptions {
  PoseSetSpec poses;         ///< The poses to fit over.
  bool moves_bind = true;    ///< Whether bind positions are fitted too.
  bool is_coupled = false;   ///< Whether neighbours are fitted together. Needs a build with Ceres.
  double smoothness = 0.01;  ///< Smoothness of coupled fits, >= 0; see docs/weights.md.
};

}  // namespace sunder
