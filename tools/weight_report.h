#pragma once

#include <sunder/tear/torn_model.h>

#include <memory>

#include "tools/report.h"

namespace sunder::tools {

/// Poses of a character over which the errors of weights are measured.
struct MeasuredPoses {
  const char* name = "";  ///< As the report names them.
  std::vector<ModelPose> poses;
};

/// The poses of a model's history; its clips and its range of motion, those to fit over and those
/// held out. Of each at most 200: where there are more, every n-th. What the character does not
/// have, or cannot be measured in, is left out.
[[nodiscard]] Result<std::vector<MeasuredPoses>> poses_to_measure(
    const TornModel& model, std::shared_ptr<const Character> source);

/// How far the points that operations made stand from where the surface was before them: one object
/// a set of poses. An empty one where nothing was done.
[[nodiscard]] Result<Json> weight_errors_json(const TornModel& model,
                                              const std::vector<MeasuredPoses>& sets);

/// The same with the weights that are in a file: barycentric ones where the model has positions per
/// influence; null where it has none.
/// @param model  as it was, afterwards, but for what could be done again.
[[nodiscard]] Result<Json> written_weight_errors_json(TornModel& model,
                                                      const std::vector<MeasuredPoses>& sets);

/// The same as if one policy had weighed all of the model's points: one object a policy.
/// @param pose  that `pose_exact` meets.
/// @param model  as it was, afterwards, but for what could be done again.
[[nodiscard]] Result<Json> weight_errors_by_policy_json(TornModel& model,
                                                        std::shared_ptr<const Character> source,
                                                        const PoseSpec& pose);

}  // namespace sunder::tools
