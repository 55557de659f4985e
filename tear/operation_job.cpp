#include <sunder/skinning/pose.h>
#include <sunder/tear/detached_piece.h>
#include <sunder/tear/operation_job.h>

#include <algorithm>
#include <atomic>
#include <new>
#include <optional>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "tear/model/instance.h"
#include "tear/model/model_state.h"

namespace sunder {
namespace tear {

/// The input and the result of an OperationJob.
struct OperationTask {
  std::shared_ptr<const TornAsset> asset;
  WeightOptions weights;
  std::vector<Operation> history;
  std::vector<std::uint64_t> serials;  ///< Of the operations that the model has done.
  Operation operation;
  std::optional<DetachOptions> detach;  ///< Of a detachment whose piece is wanted.
  OperationJob::Observer observer;
  std::optional<TornModel> replica;   ///< With the operation on its redo stack, once it is done.
  std::vector<ChangeRecord> changes;  ///< What it did to the replica.
  TearReport report;
  std::shared_ptr<const DetachedPiece> piece;
  Status failure;
  std::atomic<OperationJob::State> state = OperationJob::State::waiting;
};

}  // namespace tear

namespace {

Status refuse(const char* why) {
  return Status::failure(StatusCode::invalid_argument, kNone, "%s", why);
}

/// Performs a detachment and keeps its piece.
Result<TearReport> detach_piece(tear::OperationTask& task, TornModel& model) {
  const auto& operation = std::get<DetachOperation>(task.operation);
  const Result<ModelPose> pose = make_pose(model.character(), operation.pose);
  if (!pose) return pose.error();
  Result<DetachedPiece> piece =
      detach(model, *pose, operation.piece, *task.detach, &task.changes.emplace_back());
  if (!piece) return piece.error();
  task.piece = std::make_shared<const DetachedPiece>(std::move(*piece));
  return task.piece->report;
}

Status run_task(tear::OperationTask& task) {
  Result<TornModel> made = TornModel::create(task.asset->character());
  if (!made) return made.error();
  // Operations of a history that name no weights were done with those of a new model. With other
  // weights the replica would have other rows than the model into which its last ones are swapped.
  for (const Operation& operation : task.history)
    if (Result<TearReport> done = apply_operation(*made, operation); !done) return done.error();
  if (Status status = made->set_weights(task.weights); !status) return status;
  const std::uint32_t before = made->undo_count();
  Result<TearReport> report = task.detach ? detach_piece(task, *made)
                                          : apply_operation(*made, task.operation, &task.changes);
  if (!report) return report.error();
  if (task.observer) task.observer(*made, task.changes);
  task.report = std::move(*report);
  if (made->undo_count() > before)
    if (Status status = made->undo(); !status) return status;
  task.replica.emplace(std::move(*made));
  return {};
}

}  // namespace

OperationJob::OperationJob(std::shared_ptr<tear::OperationTask> task) : task_(std::move(task)) {}

Result<OperationJob> OperationJob::create(TornModel& model, const Operation& operation,
                                          Observer observer) {
  auto task = make_task(model, operation, std::move(observer));
  if (!task) return task.error();
  return OperationJob(std::move(*task));
}

Result<OperationJob> OperationJob::create(TornModel& model, const DetachOperation& operation,
                                          const DetachOptions& options, Observer observer) {
  auto task = make_task(model, operation, std::move(observer));
  if (!task) return task.error();
  (*task)->detach = options;
  return OperationJob(std::move(*task));
}

Result<std::shared_ptr<tear::OperationTask>> OperationJob::make_task(TornModel& model,
                                                                     const Operation& operation,
                                                                     Observer observer) {
  if (Status status = model.unpack(); !status) return status;
  const TornModel::State& state = *model.state_;
  if (std::holds_alternative<UndoOperation>(operation) ||
      std::holds_alternative<RedoOperation>(operation))
    return refuse("undo and redo do not run in the background");
  if (Status status = state.may_begin(); !status) return status;
  try {
    Result<std::vector<Operation>> history = model.history();
    if (!history) return history.error();
    auto task = std::make_shared<tear::OperationTask>();
    task->asset = model.state_.instance->asset;
    task->weights = state.weights;
    task->history = std::move(*history);
    for (const auto& entry : state.history.done()) task->serials.push_back(entry->serial);
    task->operation = operation;
    task->observer = std::move(observer);
    return task;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

void OperationJob::run() const {
  task_->state = State::running;
  try {
    task_->failure = run_task(*task_);
  } catch (const std::bad_alloc&) {
    task_->failure = out_of_memory();
  }
  task_->state = task_->failure ? State::done : State::failed;
}

OperationJob::State OperationJob::poll() const { return task_->state; }
const Status& OperationJob::failure() const { return task_->failure; }
std::shared_ptr<const DetachedPiece> OperationJob::piece() const { return task_->piece; }

Result<TearReport> OperationJob::swap_in(TornModel& model, ChangeRecord* change) const {
  if (Status status = model.unpack(); !status) return status;
  TornModel::State& state = *model.state_;
  if (Status status = state.may_begin(); !status) return status;
  if (task_->state != State::done) return refuse("the operation has not finished");
  const auto& done = state.history.done();
  if (model.state_.instance->asset != task_->asset ||
      !std::ranges::equal(done, task_->serials, {},
                          [](const auto& entry) { return entry->serial; }))
    return refuse("the operation belongs to another model, or the model has changed since");
  try {
    tear::History& from = task_->replica->state_->history;
    if (!from.undone().empty()) {
      // It does to the model what it did to the replica: the record need not be made again.
      const bool is_described = task_->changes.size() == 1;
      state.history.adopt_undone(from);
      if (Status status = model.redo(is_described ? nullptr : change); !status) {
        state.history.give_back(from);
        return status;
      }
      state.history.forget_undone();
      if (is_described && change != nullptr) *change = std::move(task_->changes[0]);
    } else if (change != nullptr) {
      *change = {};  // the operation missed
    }
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
  task_->state = State::swapped_in;
  return task_->report;
}

}  // namespace sunder
