#include "tools/model/history.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>

namespace sunder::tools {

std::vector<PoseSpec> pose_specs_of(const Operation& operation) {
  struct Visitor {
    std::vector<PoseSpec>& specs;
    void operator()(const TearOperation& tear) {
      specs.push_back(tear.pose);
      for (const TearOperation::PoseChange& change : tear.pose_changes)
        specs.push_back(change.pose);
    }
    void operator()(const CutOperation& cut) { specs.push_back(cut.pose); }
    void operator()(const DrillOperation& drill) { specs.push_back(drill.pose); }
    void operator()(const WeldOperation& weld) { specs.push_back(weld.pose); }
    void operator()(const SutureOperation& suture) { specs.push_back(suture.pose); }
    void operator()(const DetachOperation& detached) { specs.push_back(detached.pose); }
    void operator()(const WeightsOperation& weights) {
      if (weights.weights.policy == WeightPolicy::pose_exact) specs.push_back(weights.pose);
    }
    void operator()(const UndoOperation&) {}
    void operator()(const RedoOperation&) {}
  };
  std::vector<PoseSpec> specs;
  std::visit(Visitor{specs}, operation);
  return specs;
}

Result<std::vector<ModelPose>> poses_of(const Operation& operation, const Character& character) {
  std::vector<ModelPose> poses;
  for (const PoseSpec& spec : pose_specs_of(operation)) {
    Result<ModelPose> pose = make_pose(character, spec);
    if (!pose) return pose.error();
    poses.push_back(std::move(*pose));
  }
  return poses;
}

PoseSpec last_pose_of(const Operation& operation) {
  struct Visitor {
    PoseSpec operator()(const TearOperation& tear) const {
      return tear.pose_changes.empty() ? tear.pose : tear.pose_changes.back().pose;
    }
    PoseSpec operator()(const CutOperation& cut) const { return cut.pose; }
    PoseSpec operator()(const DrillOperation& drill) const { return drill.pose; }
    PoseSpec operator()(const WeldOperation& weld) const { return weld.pose; }
    PoseSpec operator()(const SutureOperation& suture) const { return suture.pose; }
    PoseSpec operator()(const DetachOperation& detached) const { return detached.pose; }
    PoseSpec operator()(const WeightsOperation& weights) const { return weights.pose; }
    PoseSpec operator()(const UndoOperation&) const { return RestPose{}; }
    PoseSpec operator()(const RedoOperation&) const { return RestPose{}; }
  };
  return std::visit(Visitor(), operation);
}

Result<std::vector<NumberedOperation>> remaining_operations(std::span<const Operation> log) {
  std::vector<NumberedOperation> done, undone;
  const auto move = [](std::vector<NumberedOperation>& from, std::vector<NumberedOperation>& to,
                       std::size_t count) {
    for (; count > 0; --count) {
      to.push_back(from.back());
      from.pop_back();
    }
  };
  for (std::size_t i = 0; i < log.size(); ++i) {
    const auto* const undo = std::get_if<UndoOperation>(&log[i]);
    const auto* const redo = std::get_if<RedoOperation>(&log[i]);
    const std::size_t count = undo != nullptr ? undo->count : redo != nullptr ? redo->count : 0;
    const std::size_t possible = undo != nullptr ? done.size() : undone.size();
    if ((undo != nullptr || redo != nullptr) && count > possible)
      return Status::failure(StatusCode::invalid_argument, static_cast<std::uint32_t>(i),
                             "/operations/%zu/count: %zu operations, but only %zu can be %s", i,
                             count, possible, undo != nullptr ? "undone" : "redone");
    if (undo != nullptr) {
      move(done, undone, count);
    } else if (redo != nullptr) {
      move(undone, done, count);
    } else {
      done.push_back({i, &log[i]});
      undone.clear();
    }
  }
  return done;
}

Result<std::vector<ModelPose>> poses_of_history(const TornModel& model) {
  const Result<std::vector<Operation>> history = model.history();
  if (!history) return history.error();
  std::vector<ModelPose> poses;
  for (const Operation& operation : *history) {
    Result<std::vector<ModelPose>> of_operation = poses_of(operation, model.source());
    if (!of_operation) return of_operation.error();
    std::ranges::move(*of_operation, std::back_inserter(poses));
  }
  return poses;
}

std::vector<PointsOfOperation> points_of_history(const std::vector<Operation>& history) {
  struct Visitor {
    std::vector<PointsOfOperation>& points;
    void operator()(const TearOperation& tear) { add(tear.options.weights); }
    void operator()(const CutOperation& cut) { add(cut.cut.weights); }
    void operator()(const DrillOperation& drill) { add(drill.bore.weights); }
    void operator()(const DetachOperation&) { points.push_back({}); }
    void operator()(const WeldOperation&) { points.push_back({}); }
    void operator()(const SutureOperation&) { points.push_back({}); }
    void operator()(const WeightsOperation& operation) {
      const std::size_t first = std::min<std::size_t>(operation.first_operation, points.size());
      const std::size_t count =
          std::min<std::size_t>(operation.operation_count, points.size() - first);
      for (std::size_t i = first; i < first + count; ++i)
        points[i].weights = operation.weights, points[i].are_reweighed = true;
      points.push_back({});
    }
    void operator()(const UndoOperation&) {}
    void operator()(const RedoOperation&) {}

    void add(const std::optional<WeightOptions>& weights) {
      points.push_back({true, weights.value_or(WeightOptions{}), false});
    }
  };
  std::vector<PointsOfOperation> points;
  for (const Operation& operation : history) std::visit(Visitor{points}, operation);
  return points;
}

}  // namespace sunder::tools
