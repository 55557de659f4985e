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

/// The poses of the model's history, of its clips and of its range of motion; the latter two as
/// poses to fit over and held-out poses. Each set has at most 200 poses: every n-th of larger ones.
/// Sets that the character does not have are left out.
[[nodiscard]] Result<std::vector<MeasuredPoses>> poses_to_measure(
    const TornModel& model, std::shared_ptr<const Character> source);

/// Distances of the points that operations created from the untorn surface: one object per set of
/// poses. Empty if there are no such points.
[[nodiscard]] Result<Json> weight_errors_json(const TornModel& model,
                                              const std::vector<MeasuredPoses>& sets);

/// The same with the weights that a file can hold: barycentric ones if the model has positions per
/// influence. Null if it has none.
/// @param model  unchanged afterwards, except for its redo stack.
[[nodiscard]] Result<Json> written_weight_errors_json(TornModel& model,
                                                      const std::vector<MeasuredPoses>& sets);

/// The same for all policies, each applied to all points: one object per policy.
/// @param pose   the pose that `pose_exact` meets.
/// @param model  unchanged afterwards, except for its redo stack.
[[nodiscard]] Result<Json> weight_errors_by_policy_json(TornModel& model,
                                                        std::shared_ptr<const Character> source,
                                                        const PoseSpec& pose);

}  // namespace sunder::tools
