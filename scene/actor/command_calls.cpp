#include "scene/actor/command_calls.h"

namespace sunder::scene {
namespace {

/// Makes the calls of commands on an instance in a pose.
class CommandCalls {
 public:
  CommandCalls(CharacterInstance& instance, const ModelPose& pose,
               std::vector<ChangeRecord>* changes, DetachedParts& piece)
      : instance_(instance), pose_(pose), changes_(changes), piece_(piece) {}

  Result<TearReport> operator()(const TearCommand& of) {
    return instance_.tear(pose_, of.stroke, of.options, record());
  }
  Result<TearReport> operator()(const PlaneCut& of) { return instance_.cut(pose_, of, record()); }
  Result<TearReport> operator()(const Bore& of) { return instance_.drill(pose_, of, record()); }
  Result<TearReport> operator()(const Weld& of) { return instance_.weld(pose_, of, record()); }
  Result<TearReport> operator()(const Suture& of) { return instance_.suture(pose_, of, record()); }
  Result<TearReport> operator()(const BeginStrokeCommand& of) {
    return report_of(instance_.begin_stroke(pose_, of.blade, of.options, of.sampling));
  }
  Result<TearReport> operator()(const ExtendStrokeCommand& of) {
    return instance_.extend_stroke(pose_, of.blade, of.seconds, record());
  }
  Result<TearReport> operator()(const EndStrokeCommand&) { return instance_.end_stroke(record()); }
  Result<TearReport> operator()(const CancelStrokeCommand&) {
    return report_of(instance_.cancel_stroke(record()));
  }
  Result<TearReport> operator()(const DetachCommand& of) {
    PieceTissue tissue;
    Result<DetachedPiece> piece = instance_.detach(pose_, of.piece, of.options, record(), &tissue);
    if (!piece) return piece.error();
    piece_.piece = std::make_shared<const DetachedPiece>(std::move(*piece));
    if (instance_.body() != nullptr)
      piece_.tissue = std::make_shared<const PieceTissue>(std::move(tissue));
    return piece_.piece->report;
  }
  Result<TearReport> operator()(const UndoCommand&) { return report_of(instance_.undo(record())); }
  Result<TearReport> operator()(const RedoCommand&) { return report_of(instance_.redo(record())); }
  Result<TearReport> operator()(const WeightsOperation& of) {
    return instance_.apply(of, changes_);
  }

 private:
  static Result<TearReport> report_of(const Status& status) {
    return status ? Result<TearReport>(TearReport()) : Result<TearReport>(status);
  }
  ChangeRecord* record() { return changes_ == nullptr ? nullptr : &changes_->emplace_back(); }

  CharacterInstance& instance_;
  const ModelPose& pose_;
  std::vector<ChangeRecord>* changes_;
  DetachedParts& piece_;
};

}  // namespace

Result<TearReport> apply_command(const SceneCommand& command, const ModelPose& pose,
                                 CharacterInstance& instance, std::vector<ChangeRecord>* changes,
                                 DetachedParts& piece) {
  return std::visit(CommandCalls(instance, pose, changes, piece), command);
}

std::optional<Operation> operation_of(const SceneCommand& command, const ModelPose& pose) {
  if (const auto* const tear = std::get_if<TearCommand>(&command))
    return TearOperation{pose, tear->stroke, {}, tear->options};
  if (const auto* const cut = std::get_if<PlaneCut>(&command)) return CutOperation{pose, *cut};
  if (const auto* const bore = std::get_if<Bore>(&command)) return DrillOperation{pose, *bore};
  if (const auto* const weld = std::get_if<Weld>(&command)) return WeldOperation{pose, *weld};
  if (const auto* const suture = std::get_if<Suture>(&command))
    return SutureOperation{pose, *suture};
  if (const auto* const weights = std::get_if<WeightsOperation>(&command)) return *weights;
  if (const auto* const detach = std::get_if<DetachCommand>(&command))
    return DetachOperation{pose, detach->piece};
  return std::nullopt;
}

}  // namespace sunder::scene
