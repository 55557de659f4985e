#pragma once

#include <sunder/operation/pose_spec.h>

#include <cstdint>
#include <string>
#include <vector>

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

/// How much the errors over a group of poses count in a fit, relative to the other groups. Each
/// number is >= 0; 0: the group is only held to what barycentric weights have there.
struct RefitImportance {
  struct OfClip {
    std::string clip;  ///< Its name.
    double factor = 1;

    bool operator==(const OfClip&) const = default;
  };
  double clips = 1;             ///< Of all clips together; each clip is a group of its own.
  std::vector<OfClip> of_clip;  ///< Factors of single clips within `clips`; others have 1.
  double range_of_motion = 1;   ///< Of the range of motion or the limited joints.
  double poses = 1;             ///< Of the given poses.

  bool operator==(const RefitImportance&) const = default;
};

/// How the policy `refit` fits weights. Over no clip, nor the rest pose, the pose of the operation,
/// the range of motion or the given poses are an operation's points worse than barycentric ones.
struct RefitOptions {
  PoseSetSpec poses;  ///< The poses over which errors are reduced.
  RefitImportance importance;
  /// The worst deviation in all poses, as the certificate of docs/certificate.md bounds it with
  /// free joints, may grow by this factor over that of barycentric weights; >= 1. 0: by any.
  double bound = 1.25;
  bool moves_bind = true;    ///< Whether bind positions are fitted too.
  bool is_coupled = false;   ///< Fits neighbours together. Needs sunder::coupled_refit.
  double smoothness = 0.01;  ///< Smoothness of coupled fits, >= 0; see docs/weights.md.
};

}  // namespace sunder
