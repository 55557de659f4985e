#pragma once

#include <sunder/tear/torn_model.h>

#include <cstddef>
#include <span>
#include <vector>

namespace sunder::tools {

/// The specs of an operation's poses, as below.
[[nodiscard]] std::vector<PoseSpec> pose_specs_of(const Operation& operation);
/// The poses of an operation: one for a tear, cut or bore; several for a tear while the model
/// moves; for weights, the pose that they meet.
[[nodiscard]] Result<std::vector<ModelPose>> poses_of(const Operation& operation,
                                                      const Character& character);
/// The pose in which an operation ends; rest for undo and redo.
[[nodiscard]] PoseSpec last_pose_of(const Operation& operation);
/// The poses of a model's whole history, in order.
[[nodiscard]] Result<std::vector<ModelPose>> poses_of_history(const TornModel& model);

/// How the points that one operation of a history created are skinned.
struct PointsOfOperation {
  bool are_there = false;  ///< False for the operations "weights", undo and redo.
  WeightOptions weights;   ///< Of the operation, or of the most recent "weights" after it.
  bool are_reweighed = false;
};
/// One entry per operation.
[[nodiscard]] std::vector<PointsOfOperation> points_of_history(
    const std::vector<Operation>& history);

/// An operation of a log and its index there.
struct NumberedOperation {
  std::size_t index = 0;
  const Operation* operation = nullptr;
};
/// The operations of a log that its undos leave, in order; no undo or redo among them.
/// @return invalid_argument, with the index of an undo or redo of more operations than there are.
[[nodiscard]] Result<std::vector<NumberedOperation>> remaining_operations(
    std::span<const Operation> log);

}  // namespace sunder::tools
