#pragma once

#include <sunder/tear/torn_weights.h>

#include <cstdint>
#include <optional>

#include "bench/weights/weights_scene.h"

namespace sunder::bench {

/// Errors of the points of all tears of a model, over some poses, as fractions of the diagonal.
using ErrorStatistics = WeightErrors::Statistics;

struct PolicyErrors {
  struct OverPoses {
    ErrorStatistics fit, held_out;
  };
  std::optional<OverPoses> clips;  ///< As WeightsModel::clips.
  OverPoses range_of_motion;
  /// The largest error in the pose of the tear; for `pose_exact`, of points that can meet the pose.
  double pop = 0;
  std::uint32_t ill_conditioned = 0;  ///< Number of points of `pose_exact` that fell back.
};

/// Weighs the points of all tears, measures, and undoes this. `refit` is fitted to the same poses
/// over which it is measured.
[[nodiscard]] PolicyErrors measure_policy(WeightsModel& model, const WeightOptions& options);

/// Largest distance of `exact` points in SkinnedMesh, which computes in float, from their exact
/// positions over all poses, as a fraction of the diagonal.
[[nodiscard]] double largest_runtime_error(WeightsModel& model);

}  // namespace sunder::bench
