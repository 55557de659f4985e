#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

namespace sunder {
namespace {

class Replay {
  /// Runs one call of the model and keeps its record.
  template <class Call>
  auto step(Call call) const {
    ChangeRecord change;
    auto outcome = call(changes_ != nullptr ? &change : nullptr);
    if (outcome && changes_ != nullptr) changes_->push_back(std::move(change));
    return outcome;
  }

 public:
  Replay(TornModel& model, std::vector<ChangeRecord>* changes) : model_(model), changes_(changes) {}

  Result<TearReport> operator()(const TearOperation& operation) const {
    const Result<ModelPose> pose = make_pose(model_.character(), operation.pose);
    if (!pose) return pose.error();
    if (operation.pose_changes.empty())
      return step([&](ChangeRecord* change) {
        return model_.tear(*pose, operation.stroke, operation.options, change);
      });
    return tear_while_moving(*pose, operation);
  }
  Result<TearReport> operator()(const CutOperation& operation) const {
    const Result<ModelPose> pose = make_pose(model_.character(), operation.pose);
    if (!pose) return pose.error();
    return step([&](ChangeRecord* change) { return model_.cut(*pose, operation.cut, change); });
  }
  Result<TearReport> operator()(const DrillOperation& operation) const {
    const Result<ModelPose> pose = make_pose(model_.character(), operation.pose);
    if (!pose) return pose.error();
    return step([&](ChangeRecord* change) { return model_.drill(*pose, operation.bore, change); });
  }
  Result<TearReport> operator()(const WeightsOperation& operation) const {
    const auto weighed =
        step([&](ChangeRecord* change) { return model_.reweigh(operation, change); });
    if (!weighed) return weighed.error();
    TearReport report;
    report.weights = *weighed;
    return report;
  }
  Result<TearReport> operator()(const UndoOperation& operation) const {
    return repeat(operation.count, model_.undo_count(), "undone", &TornModel::undo);
  }
  Result<TearReport> operator()(const RedoOperation& operation) const {
    return repeat(operation.count, model_.redo_count(), "redone", &TornModel::redo);
  }

 private:
  Result<TearReport> repeat(std::uint32_t count, std::uint32_t available, const char* what,
                            Status (TornModel::*once)(ChangeRecord*)) const {
    if (count > available)
      return Status::failure(StatusCode::not_found, kNone,
                             "%u operations are to be %s, but there are only %u", count, what,
                             available);
    for (std::uint32_t i = 0; i < count; ++i)
      if (Status status = step([&](ChangeRecord* change) { return (model_.*once)(change); });
          !status)
        return status;
    return TearReport{};
  }

  Result<TearReport> tear_while_moving(const ModelPose& first_pose,
                                       const TearOperation& operation) const {
    std::vector<ModelPose> poses;
    for (std::size_t i = 0; i < operation.pose_changes.size(); ++i) {
      const auto& change = operation.pose_changes[i];
      const std::uint32_t after = i == 0 ? 0 : operation.pose_changes[i - 1].blade;
      if (change.blade <= after || change.blade >= operation.stroke.size())
        return Status::failure(
            StatusCode::invalid_argument, change.blade,
            "pose change %zu is at blade %u; blades must ascend, from 1 to the last of the stroke",
            i, change.blade);
      auto pose = make_pose(model_.character(), change.pose);
      if (!pose) return pose.error();
      poses.push_back(std::move(*pose));
    }
    if (operation.stroke.size() < 2)
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "a stroke needs at least two blades");
    const std::size_t changes_before = changes_ != nullptr ? changes_->size() : 0;
    auto stroke =
        TearStroke::create(model_, first_pose, operation.stroke.front(), operation.options);
    if (!stroke) return stroke.error();
    auto report = tear_blade_by_blade(*stroke, first_pose, poses, operation);
    if (report) return report;
    // A stroke that fails midway is cancelled as a whole.
    (void)stroke->cancel();
    if (changes_ != nullptr) changes_->resize(changes_before);
    return report;
  }

  /// @param poses  the poses of operation.pose_changes.
  Result<TearReport> tear_blade_by_blade(TearStroke& stroke, const ModelPose& first_pose,
                                         const std::vector<ModelPose>& poses,
                                         const TearOperation& operation) const {
    std::size_t next_change = 0;
    const ModelPose* pose = &first_pose;
    for (std::uint32_t blade = 1; blade < operation.stroke.size(); ++blade) {
      if (next_change < poses.size() && operation.pose_changes[next_change].blade == blade)
        pose = &poses[next_change++];
      const auto extended = step([&](ChangeRecord* change) {
        return stroke.extend(*pose, operation.stroke[blade], 0.0, change);
      });
      if (!extended) return extended.error();
    }
    return step([&](ChangeRecord* change) { return stroke.end(change); });
  }

  TornModel& model_;
  std::vector<ChangeRecord>* changes_;
};

}  // namespace

Result<TearReport> apply_operation(TornModel& model, const Operation& operation,
                                   std::vector<ChangeRecord>* changes) {
  return std::visit(Replay(model, changes), operation);
}

}  // namespace sunder
