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
  OperationJob::Observer observer;
  std::optional<TornModel> replica;  ///< With the operation on its redo stack, once it is done.
  TearReport report;
  Status failure;
  std::atomic<OperationJob::State> state = OperationJob::State::waiting;
};

}  // namespace tear

namespace {

Status refuse(const char* why) {
  return Status::failure(StatusCode::invalid_argument, kNone, "%s", why);
}

Status run_task(tear::OperationTask& task) {
  Result<TornModel> made = TornModel::create(task.asset->character());
  if (!made) return made.error();
  if (Status status = made->set_weights(task.weights); !status) return status;
  for (const Operation& operation : task.history)
    if (Result<TearReport> done = apply_operation(*made, operation); !done) return done.error();
  const std::uint32_t before = made->undo_count();
  std::vector<ChangeRecord> changes;
  Result<TearReport> report =
      apply_operation(*made, task.operation, task.observer ? &changes : nullptr);
  if (!report) return report.error();
  if (task.observer) task.observer(*made, changes);
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
    return OperationJob(std::move(task));
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
      state.history.adopt_undone(from);
      if (Status status = model.redo(change); !status) {
        state.history.give_back(from);
        return status;
      }
      state.history.forget_undone();
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
