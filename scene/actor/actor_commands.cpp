#include "scene/actor/actor_commands.h"

#include <system_error>
#include <utility>

#include "scene/actor/command_calls.h"

namespace sunder::scene {
namespace {

/// Whether a command belongs to a stroke.
bool is_of_stroke(const SceneCommand& command) {
  return std::holds_alternative<BeginStrokeCommand>(command) ||
         std::holds_alternative<ExtendStrokeCommand>(command) ||
         std::holds_alternative<EndStrokeCommand>(command) ||
         std::holds_alternative<CancelStrokeCommand>(command);
}

bool may_run_in_background(const SceneCommand& command) {
  return !is_of_stroke(command) && !std::holds_alternative<UndoCommand>(command) &&
         !std::holds_alternative<RedoCommand>(command);
}

/// Lets the background run a job, and what follows it.
template <class Job, class Next>
std::shared_ptr<OnceJob> begin(const Job& job, Background& background, Next next) {
  auto once = std::make_shared<OnceJob>([job, next] {
    job.run();
    next();
  });
  background.start([once] { once->run(); });
  return once;
}

/// An asset of a piece, as those of the instance that it came off. Null without enough memory.
std::shared_ptr<const CharacterAsset> asset_of(const DetachedPiece* piece,
                                               CharacterAssetOptions options) {
  if (piece == nullptr || piece->character == nullptr) return nullptr;
  options.coarser = nullptr;
  const auto asset = CharacterAsset::create(piece->character, options);
  return asset ? *asset : nullptr;
}

/// @param report  of a command that ran in the frame.
bool advises_background(const SceneCommand& command, const TearReport& report) {
  return may_run_in_background(command) &&
         std::uint64_t{report.vertices_added} + report.triangles_added + report.triangles_retired >
             kElementsOfFrame;
}

Result<TearReport> report_of(Result<WeightReport> weights) {
  if (!weights) return weights.error();
  TearReport report;
  report.weights = *weights;
  return report;
}

}  // namespace

CommandResult& ActorCommands::add_result(const QueuedCommand& queued) {
  CommandResult& result = results_.emplace_back();
  result.command = queued.id;
  result.instance = queued.instance;
  return result;
}

void ActorCommands::conclude(const QueuedCommand& queued, Result<TearReport> report) {
  CommandResult& result = add_result(queued);
  if (report)
    result.report = std::move(*report);
  else
    result.status = report.error();
}

void ActorCommands::give(DetachedParts parts) {
  results_.back().piece = std::move(parts.piece);
  results_.back().tissue = std::move(parts.tissue);
  results_.back().asset = std::move(parts.asset);
}

Status ActorCommands::start_operation(RunningOperation& operation, CharacterInstance& instance,
                                      Background& background) {
  const auto* const detach = std::get_if<DetachCommand>(&operation.in_background.queued.command);
  Result<OperationJob> job =
      detach != nullptr
          ? instance.begin_detach(std::get<DetachOperation>(operation.operation), detach->options)
          : instance.begin_operation(operation.operation);
  if (!job) return job.error();
  operation.asset = std::make_shared<std::shared_ptr<const CharacterAsset>>();
  operation.in_background.job =
      begin(*job, background, [job = *job, to = operation.asset, of = instance.asset()] {
        *to = asset_of(job.piece().get(), of->options());
      });
  operation.in_background.time = background.swap_time();
  operation.job = std::move(*job);
  operation.is_outdated = false;
  return {};
}

Status ActorCommands::start(const QueuedCommand& queued, const ModelPose& pose,
                            CharacterInstance& instance, Background& background) {
  const auto* const weights = std::get_if<WeightsOperation>(&queued.command);
  try {
    if (weights != nullptr && weights->weights.policy == WeightPolicy::refit) {
      Result<RefitJob> job = instance.begin_refit(*weights);
      if (!job) return job.error();
      refits_.push_back({{queued, begin(*job, background, [] {}), background.swap_time()}, *job});
      return {};
    }
    std::optional<Operation> operation = operation_of(queued.command, pose);
    if (!operation)
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "commands of strokes, undo and redo do not run in the background");
    auto running = std::make_unique<RunningOperation>(RunningOperation{
        {queued, nullptr, background.swap_time()}, std::move(*operation), {}, {}, false});
    Status status = start_operation(*running, instance, background);
    if (status) operation_ = std::move(running);
    return status;
  } catch (const std::system_error& error) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "cannot start a thread: %s",
                           error.what());
  }
}

void ActorCommands::apply(const ModelPose& pose, CharacterInstance& instance,
                          Background& background) {
  std::size_t next = 0;
  for (; next < waiting_.size(); ++next) {
    const QueuedCommand& queued = waiting_[next];
    if (operation_) {
      if (!is_of_stroke(queued.command) || queued.options.in_background) break;
      operation_->is_outdated = true;
    }
    if (queued.options.in_background) {
      if (const Status status = start(queued, pose, instance, background); !status)
        conclude(queued, status);
      continue;
    }
    std::vector<ChangeRecord> changes;
    DetachedParts detached;
    conclude(queued, apply_command(queued.command, pose, instance,
                                   queued.options.wants_changes ? &changes : nullptr, detached));
    CommandResult& result = results_.back();
    result.advises_background = advises_background(queued.command, result.report);
    result.changes = std::move(changes);
    give(std::move(detached));
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(next));
}

void ActorCommands::finish_operation(CharacterInstance& instance, Background& background) {
  if (!operation_) return;
  const QueuedCommand& queued = operation_->in_background.queued;
  if (operation_->is_outdated) {
    if (instance.is_in_stroke()) return;
    if (Status status = start_operation(*operation_, instance, background); !status) {
      conclude(queued, status);
      operation_.reset();
    }
    return;
  }
  if (!operation_->in_background.time.has_come(*operation_->in_background.job)) return;
  ChangeRecord change;
  PieceTissue tissue;
  conclude(queued, instance.swap_in(*operation_->job, &change, &tissue));
  if (results_.back().status && queued.options.wants_changes)
    results_.back().changes.push_back(std::move(change));
  if (results_.back().status && std::holds_alternative<DetachCommand>(queued.command)) {
    DetachedParts parts = {operation_->job->piece(), nullptr, std::move(*operation_->asset)};
    if (instance.body() != nullptr)
      parts.tissue = std::make_shared<const PieceTissue>(std::move(tissue));
    give(std::move(parts));
  }
  // To free the replica takes time too.
  background.start(
      [job = std::move(operation_->job), once = std::move(operation_->in_background.job)] {});
  operation_.reset();
}

bool ActorCommands::finish_refits(CharacterInstance& instance) {
  for (auto refit = refits_.begin(); refit != refits_.end(); ++refit) {
    if (!refit->in_background.time.has_come(*refit->in_background.job)) continue;
    const QueuedCommand& queued = refit->in_background.queued;
    ChangeRecord change;
    conclude(queued, refit->job.poll() == RefitJob::State::failed
                         ? Result<TearReport>(refit->job.failure())
                         : report_of(instance.swap_in(refit->job, &change)));
    if (queued.options.wants_changes) results_.back().changes.push_back(std::move(change));
    refits_.erase(refit);
    return true;  // one per update
  }
  return false;
}

void ActorCommands::abandon(const Status& why) {
  if (operation_) conclude(operation_->in_background.queued, why);
  for (const RunningRefit& refit : refits_) conclude(refit.in_background.queued, why);
  for (const QueuedCommand& queued : waiting_) conclude(queued, why);
}

bool ActorCommands::finish_background(CharacterInstance& instance, Background& background,
                                      bool may_refit) {
  finish_operation(instance, background);
  return may_refit && waiting_.empty() && !operation_ && !instance.is_in_stroke() &&
         finish_refits(instance);
}

}  // namespace sunder::scene
