#include <sunder/skinning/pose.h>
#include <sunder/tear/detached_piece.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

class Replay {
  /// Runs one call of the model and keeps its record.
  template <class Call>
  auto step(Call call) const {
    if (changes_ == nullptr) return call(nullptr);
    changes_->emplace_back();  // first, so that nothing fails after the call
    auto outcome = call(&changes_->back());
    if (!outcome) changes_->pop_back();
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
  Result<TearReport> operator()(const WeldOperation& operation) const {
    const Result<ModelPose> pose = make_pose(model_.character(), operation.pose);
    if (!pose) return pose.error();
    return step([&](ChangeRecord* change) { return model_.weld(*pose, operation.weld, change); });
  }
  Result<TearReport> operator()(const SutureOperation& operation) const {
    const Result<ModelPose> pose = make_pose(model_.character(), operation.pose);
    if (!pose) return pose.error();
    return step(
        [&](ChangeRecord* change) { return suture(model_, *pose, operation.suture, change); });
  }
  Result<TearReport> operator()(const DetachOperation& operation) const {
    const Result<ModelPose> pose = make_pose(model_.character(), operation.pose);
    if (!pose) return pose.error();
    DetachOptions nothing;
    nothing.motion = PieceMotion::none;
    auto piece = step([&](ChangeRecord* change) {
      return detach(model_, *pose, operation.piece, nothing, change);
    });
    if (!piece) return piece.error();
    return std::move(piece->report);
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
    return repeat(operation.count, model_.undo_count(), "undone", &TornModel::undo,
                  &TornModel::redo);
  }
  Result<TearReport> operator()(const RedoOperation& operation) const {
    return repeat(operation.count, model_.redo_count(), "redone", &TornModel::redo,
                  &TornModel::undo);
  }

 private:
  using Step = Status (TornModel::*)(ChangeRecord*);

  /// @param back  reverts what `once` does; it needs no memory right after it.
  Result<TearReport> repeat(std::uint32_t count, std::uint32_t available, const char* what,
                            Step once, Step back) const {
    if (count > available)
      return Status::failure(StatusCode::not_found, kNone,
                             "%u operations are to be %s, but there are only %u", count, what,
                             available);
    for (std::uint32_t i = 0; i < count; ++i)
      if (Status status = try_step(once); !status) {
        for (; i > 0; --i) (void)(model_.*back)(nullptr);
        return status;
      }
    return TearReport{};
  }

  [[nodiscard]] Status try_step(Step once) const {
    return or_out_of_memory(
        [&] { return step([&](ChangeRecord* change) { return (model_.*once)(change); }); });
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
    auto stroke =
        TearStroke::create(model_, first_pose, operation.stroke.front(), operation.options);
    if (!stroke) return stroke.error();
    auto report = tear_blade_by_blade(*stroke, first_pose, poses, operation);
    if (report) return report;
    (void)stroke->cancel();  // a stroke that fails midway is cancelled as a whole
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
  const std::size_t changes_before = changes != nullptr ? changes->size() : 0;
  auto report = or_out_of_memory([&] { return std::visit(Replay(model, changes), operation); });
  if (!report && changes != nullptr) changes->resize(changes_before);
  return report;
}

}  // namespace sunder
