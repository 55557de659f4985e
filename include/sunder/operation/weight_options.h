#pragma once

#include <sunder/operation/pose_spec.h>

#include <cstdint>

namespace sunder {

/// What a point that an operation makes follows the pose by. See docs/weights.md.
enum class WeightPolicy : std::uint8_t {
  barycentric,  ///< Bind position and weights are the mean of the corners'. The point pops where
                ///< bones turn apart.
  pose_exact,  ///< The same weights; the bind position is such that the operation's own pose is met
               ///< exactly.
  refit,       ///< Weights and bind position fitted over many poses, beside the frame; until then
               ///< `barycentric`.
  exact,       ///< A bind position for each influence: exact in every pose. See
               ///< TornModel::influence_positions().
};

/// The enumerator's own name, as logs and the command have it.
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
  std::uint32_t maximum_influences =
      0;  ///< The largest are kept, and add up to one. 0: all. `exact` takes all.

  bool operator==(const WeightOptions&) const = default;
};

/// How `refit` fits.
struct RefitOptions {
  PoseSetSpec poses;         ///< Over which.
  bool moves_bind = true;    ///< Whether bind positions are fitted too.
  bool is_coupled = false;   ///< Whether neighbours are fitted together. Needs a build with Ceres.
  double smoothness = 0.01;  ///< Of those, see CoupledRefitOptions; >= 0.
};

}  // namespace sunder
