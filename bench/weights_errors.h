#pragma once

#include <sunder/tear/torn_weights.h>

#include <cstdint>
#include <optional>

#include "bench/weights_scene.h"

namespace sunder::bench {

/// Errors of the points of all tears of a model, over some poses, as fractions of the diagonal.
using ErrorStatistics = WeightErrors::Statistics;

struct PolicyErrors {
  struct OverPoses {
    ErrorStatistics fit, held_out;
  };
  std::optional<OverPoses> clips;  ///< As WeightsModel::clips.
  OverPoses range_of_motion;
  double pop = 0;  ///< The largest in the pose of the tear; of `pose_exact`, where it can be met.
  std::uint32_t ill_conditioned = 0;  ///< Points of `pose_exact` that fell back.
};

/// Weighs the points of all tears, measures, and takes it back. `refit` is fitted to the set of
/// poses that it is measured on.
[[nodiscard]] PolicyErrors measure_policy(WeightsModel& model, const WeightOptions& options);

/// How far `exact` points of SkinnedMesh, which is in float, stand from where they belong, over all
/// poses, in double: the largest, in parts of the diagonal.
[[nodiscard]] double largest_runtime_error(WeightsModel& model);

}  // namespace sunder::bench
