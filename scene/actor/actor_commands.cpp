#include "scene/actor/actor_commands.h"

#include <system_error>
#include <utility>

#include "scene/actor/command_calls.h"

namespace sunder::scene {
namespace {

template <class Job>
bool is_finished(const Job& job) {
  const typename Job::State state = job.poll();
  return state != Job::State::waiting && state != Job::State::running;
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

Status ActorCommands::start(const QueuedCommand& queued, const ModelPose& pose,
                            CharacterInstance& instance, Background& background) {
  const auto* const weights = std::get_if<WeightsOperation>(&queued.command);
  try {
    if (weights != nullptr && weights->weights.policy == WeightPolicy::refit) {
      Result<RefitJob> job = instance.begin_refit(*weights);
      if (!job) return job.error();
      refits_.push_back({queued, *job});
      background.start([job = *job] { job.run(); });
      return {};
    }
    const std::optional<Operation> operation = operation_of(queued.command, pose);
    if (!operation)
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "commands of strokes, undo and redo do not run in the background");
    Result<OperationJob> job = instance.begin_operation(*operation);
    if (!job) return job.error();
    background.start([job = *job] { job.run(); });
    operation_.emplace(InBackground<OperationJob>{queued, *job});
    return {};
  } catch (const std::system_error& error) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "cannot start a thread: %s",
                           error.what());
  }
}

void ActorCommands::apply(const ModelPose& pose, CharacterInstance& instance,
                          Background& background) {
  std::size_t next = 0;
  for (; next < waiting_.size() && !operation_; ++next) {
    const QueuedCommand& queued = waiting_[next];
    if (queued.options.in_background) {
      if (const Status status = start(queued, pose, instance, background); !status)
        conclude(queued, status);
      continue;
    }
    std::vector<ChangeRecord> changes;
    std::shared_ptr<const DetachedPiece> piece;
    conclude(queued, apply_command(queued.command, pose, instance,
                                   queued.options.wants_changes ? &changes : nullptr, piece));
    results_.back().changes = std::move(changes);
    results_.back().piece = std::move(piece);
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(next));
}

void ActorCommands::finish_operation(CharacterInstance& instance) {
  if (!operation_ || !is_finished(operation_->job)) return;
  ChangeRecord change;
  const OperationJob& job = operation_->job;
  const bool is_done = job.poll() == OperationJob::State::done;
  conclude(operation_->queued,
           is_done ? instance.swap_in(job, &change) : Result<TearReport>(job.failure()));
  if (is_done && operation_->queued.options.wants_changes)
    results_.back().changes.push_back(std::move(change));
  operation_.reset();
}

void ActorCommands::finish_refits(CharacterInstance& instance) {
  for (auto refit = refits_.begin(); refit != refits_.end(); ++refit) {
    if (!is_finished(refit->job)) continue;
    ChangeRecord change;
    conclude(refit->queued, refit->job.poll() == RefitJob::State::failed
                                ? Result<TearReport>(refit->job.failure())
                                : report_of(instance.swap_in(refit->job, &change)));
    if (refit->queued.options.wants_changes) results_.back().changes.push_back(std::move(change));
    refits_.erase(refit);
    return;  // one per update
  }
}

void ActorCommands::abandon(const Status& why) {
  if (operation_) conclude(operation_->queued, why);
  for (const auto& refit : refits_) conclude(refit.queued, why);
  for (const QueuedCommand& queued : waiting_) conclude(queued, why);
}

void ActorCommands::finish_background(CharacterInstance& instance) {
  finish_operation(instance);
  if (waiting_.empty() && !instance.is_in_stroke()) finish_refits(instance);
}

}  // namespace sunder::scene
