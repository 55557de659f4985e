#pragma once

#include <sunder/tear/torn_model.h>

#include <vector>

namespace sunder::tools {

/// The poses in which an operation is done: one of a tear, cut or bore, more of a tear while the
/// model moves, and that which weights are to meet.
[[nodiscard]] Result<std::vector<ModelPose>> poses_of(const Operation& operation,
                                                      const Character& character);
/// Those of a model's whole history, in order.
[[nodiscard]] Result<std::vector<ModelPose>> poses_of_history(const TornModel& model);

/// What the points follow the pose by that one operation of a history made.
struct PointsOfOperation {
  bool are_there = false;  ///< An operation "weights" makes none.
  WeightOptions weights;   ///< As it, or the newest "weights" over it, has them.
  bool are_reweighed = false;
};
/// One an operation.
[[nodiscard]] std::vector<PointsOfOperation> points_of_history(
    const std::vector<Operation>& history);

}  // namespace sunder::tools
