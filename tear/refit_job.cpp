#include <sunder/tear/refit_job.h>

#include <algorithm>
#include <new>

#include "core/internal/out_of_memory.h"
#include "tear/model/model_state.h"
#include "tear/weights/refit_poses.h"

namespace sunder {

RefitJob::RefitJob(std::shared_ptr<tear::RefitTask> task) : task_(std::move(task)) {}

Result<RefitJob> RefitJob::create(TornModel& model, const WeightsOperation& wanted) {
  if (Status status = model.unpack(); !status) return status;
  TornModel::State& state = *model.state_;
  if (Status status = state.may_begin(); !status) return status;
  if (wanted.weights.policy != WeightPolicy::refit)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "a refit job needs the policy 'refit'");
  try {
    WeightsOperation resolved = wanted;
    if (Status status = state.resolve(resolved); !status) return status;
    resolved.pose = RestPose{};
    if (Status status = tear::RefitPoses::check(*state.source, wanted.refit); !status)
      return status;
    const tear::VertexRanges ranges = state.vertices_of(resolved);
    const auto points = tear::interpolated_points(ranges, state.editor);
    WeightReport report;
    tear::WeightAssignment assignment =
        tear::compute_weights(points, wanted.weights, {}, state.editor, report);
    auto task = std::make_shared<tear::RefitTask>(
        state.source, std::move(resolved), std::move(assignment),
        state.history.done()[wanted.first_operation]->begin, state.editor);
    task->report = report;
    const auto& done = state.history.done();
    for (std::uint32_t i = 0; i < task->operation.operation_count; ++i) {
      const tear::History::Entry& entry = *done[task->operation.first_operation + i];
      task->add_operation(entry.operation, entry.serial,
                          state.editor.log.vertex_counts_at(entry.begin));
    }
    std::erase_if(state.refits,
                  [](const std::weak_ptr<tear::RefitTask>& refit) { return refit.expired(); });
    state.refits.push_back(task);
    return RefitJob(std::move(task));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

void RefitJob::run() const { task_->run(); }

RefitJob::State RefitJob::poll() const { return task_->state; }

void RefitJob::cancel() const { task_->cancel(); }

const Status& RefitJob::failure() const { return task_->failure; }

Result<WeightReport> RefitJob::swap_in(TornModel& model, ChangeRecord* change) const {
  if (Status status = model.unpack(); !status) return status;
  TornModel::State& of_model = *model.state_;
  if (Status status = of_model.may_begin(); !status) return status;
  const WeightsOperation& operation = task_->operation;
  if (task_->state == State::cancelled)
    return Status::failure(StatusCode::invalid_argument, kNone, "this refit was cancelled");
  if (task_->state != State::done)
    return Status::failure(StatusCode::invalid_argument, kNone, "this refit has not finished");
  const auto& done = of_model.history.done();
  for (std::size_t i = 0; i < task_->operations.size(); ++i)
    if (operation.first_operation + i >= done.size() ||
        done[operation.first_operation + i]->serial != task_->operations[i].serial)
      return Status::failure(
          StatusCode::invalid_argument, kNone,
          "this refit belongs to another model or to operations that were undone");
  if (Status status = of_model.reweigh(operation, task_->assignment, change); !status)
    return status;
  task_->state = State::swapped_in;
  return task_->report;
}

}  // namespace sunder
