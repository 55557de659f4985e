#pragma once

#include <sunder/tear/torn_model.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "tools/messages/json.h"

namespace sunder::tools {

/// A part of a model's points and poses, so that measuring takes less than a second. It depends on
/// the model's history alone.
struct WeightSample {
  /// Successive operations of the history, evenly spread.
  struct Operations {
    std::uint32_t first = 0, count = 0;
  };
  std::vector<Operations> operations;
  std::size_t points_of = 0;   ///< All points that operations created.
  std::size_t most_poses = 0;  ///< Per set: of larger sets, every n-th pose.
};
[[nodiscard]] Result<WeightSample> choose_sample(const TornModel& model);

/// Poses over which the errors of weights are measured.
struct MeasuredPoses {
  const char* name = "";  ///< The name in the report.
  std::vector<ModelPose> poses;
  std::size_t poses_of = 0;  ///< Number in the whole set.
};

/// The poses of the model's history, of its clips and of its range of motion; the latter two as
/// poses to fit over and held-out poses. Sets that the character does not have are left out.
[[nodiscard]] Result<std::vector<MeasuredPoses>> poses_to_measure(
    const TornModel& model, const std::shared_ptr<const Character>& source,
    const WeightSample& sample);

/// Distances of the points that operations created from the untorn surface: one object per set of
/// poses. Empty if there are no such points.
[[nodiscard]] Result<Json> weight_errors_json(const TornModel& model,
                                              const std::vector<MeasuredPoses>& sets,
                                              const WeightSample& sample);

/// The same with the weights that a file can hold: barycentric ones if the model has positions per
/// influence. Null if it has none.
/// @param model  unchanged afterwards, except for its redo stack.
[[nodiscard]] Result<Json> written_weight_errors_json(TornModel& model,
                                                      const std::vector<MeasuredPoses>& sets,
                                                      const WeightSample& sample);

/// The same for all policies, each applied to all points: one object per policy.
/// @param pose   the pose that `pose_exact` meets.
/// @param model  unchanged afterwards, except for its redo stack.
[[nodiscard]] Result<Json> weight_errors_by_policy_json(TornModel& model,
                                                        std::shared_ptr<const Character> source,
                                                        const PoseSpec& pose);

}  // namespace sunder::tools
