#pragma once

#include <sunder/tear/torn_model.h>

#include <memory>

#include "tools/report.h"

namespace sunder::tools {

/// Poses over which the errors of weights are measured.
struct MeasuredPoses {
  const char* name = "";  ///< The name in the report.
  std::vector<ModelPose> poses;
};

/// The poses of the model's history, of its clips and of its range of motion; of the latter two
/// those to fit over and those held out. Each set has at most 200 poses: every n-th of larger ones.
/// Sets that the character does not have are left out.
[[nodiscard]] Result<std::vector<MeasuredPoses>> poses_to_measure(
    const TornModel& model, std::shared_ptr<const Character> source);

/// How far the points that operations created lie from the surface as it was: one object per set of
/// poses. Empty if nothing was done.
[[nodiscard]] Result<Json> weight_errors_json(const TornModel& model,
                                              const std::vector<MeasuredPoses>& sets);

/// The same with the weights that a file holds: barycentric ones where the model has positions per
/// influence; null if it has none.
/// @param model  unchanged afterwards, except for its redo stack.
[[nodiscard]] Result<Json> written_weight_errors_json(TornModel& model,
                                                      const std::vector<MeasuredPoses>& sets);

/// The same as if one policy had been used for all points: one object per policy.
/// @param pose   the pose that `pose_exact` meets.
/// @param model  unchanged afterwards, except for its redo stack.
[[nodiscard]] Result<Json> weight_errors_by_policy_json(TornModel& model,
                                                        std::shared_ptr<const Character> source,
                                                        const PoseSpec& pose);

}  // namespace sunder::tools
