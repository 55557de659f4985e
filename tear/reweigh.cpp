// Weights of points that earlier operations made: at once, and by jobs beside the frame.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/refit_job.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "tear/model_state.h"

namespace sunder {

Status TornModel::State::resolve(WeightsOperation& wanted) const {
  if (Status status = validate_weights(wanted.weights); !status) return status;
  const auto done = static_cast<std::uint32_t>(history.done().size());
  if (wanted.first_operation >= done)
    return Status::failure(StatusCode::not_found, wanted.first_operation,
                           "weights are wanted from operation %u on, there are %u",
                           wanted.first_operation, done);
  if (wanted.operation_count == kNone) wanted.operation_count = done - wanted.first_operation;
  if (wanted.operation_count == 0 || wanted.operation_count > done - wanted.first_operation)
    return Status::failure(StatusCode::not_found, wanted.first_operation,
                           "weights are wanted of %u operations from operation %u on, there are %u",
                           wanted.operation_count, wanted.first_operation, done);
  if (wanted.weights.policy != WeightPolicy::refit) return {};
  if (!std::isfinite(wanted.refit.smoothness) || wanted.refit.smoothness < 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "a refit's smoothness is finite and not negative, not %g",
                           wanted.refit.smoothness);
  if (wanted.refit.is_coupled && !has_coupled_refit())
    return Status::failure(
        StatusCode::unsupported_feature, kNone,
        "a coupled refit takes Ceres, without which this was built (SUNDER_CERES)");
  return {};
}

tear::VertexRanges TornModel::State::vertices_of(const WeightsOperation& resolved) const {
  const auto& done = history.done();
  const std::vector<std::uint32_t> first =
      editor.vertex_counts_at(done[resolved.first_operation]->begin);
  const std::size_t after = std::size_t{resolved.first_operation} + resolved.operation_count;
  const std::vector<std::uint32_t> end = after < done.size()
                                             ? editor.vertex_counts_at(done[after]->begin)
                                             : std::vector<std::uint32_t>();
  tear::VertexRanges ranges;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh)
    ranges.push_back(
        {first[mesh], end.empty() ? character.meshes[mesh].vertex_count() : end[mesh]});
  return ranges;
}

Status TornModel::State::reweigh(const WeightsOperation& resolved, const tear::Weighing& weighing,
                                 ChangeRecord* change) {
  const tear::SurfaceEditor::Mark begin = editor.mark();
  try {
    tear::History::Entry& entry = history.next();
    entry.as<WeightsOperation>() = resolved;
    entry.begin = begin;
    entry.weights = tear::change_to(weighing, vertices_of(resolved), editor);
    if (change != nullptr) editor.describe(entry.weights, *change);
    editor.exchange(entry.weights);  // last, for it cannot be rolled back
  } catch (const tear::CapacityExceeded& exceeded) {
    editor.roll_back(begin);
    return no_room(exceeded);
  } catch (const std::bad_alloc&) {
    editor.roll_back(begin);
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  history.push({});
  return {};
}

Result<WeightReport> TornModel::reweigh(const WeightsOperation& wanted, ChangeRecord* change) {
  if (wanted.weights.policy == WeightPolicy::refit) {
    const auto job = RefitJob::create(*this, wanted);
    if (!job) return job.error();
    job->run();
    if (job->poll() == RefitJob::State::failed) return job->failure();
    return job->swap_in(*this, change);
  }
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  WeightsOperation resolved = wanted;
  if (Status status = state.resolve(resolved); !status) return status;
  auto pose = make_pose(state.character, wanted.pose);
  if (!pose) return pose.error();
  if (Status status = tear::PosedPoints::check(state.character, *pose); !status) return status;
  resolved.pose = *pose;
  std::vector<std::vector<Affine3d>> palettes;
  for (const Skin& skin : state.character.skins) {
    palettes.emplace_back(skin.bones.size());
    if (Status status = compute_palette(skin, *pose, palettes.back()); !status) return status;
  }
  WeightReport report;
  try {
    const auto points = tear::weighable_points(state.vertices_of(resolved), state.editor);
    const tear::Weighing weighing =
        tear::weigh(points, wanted.weights, palettes, pose->morph_weights, state.editor, report);
    if (Status status = state.reweigh(resolved, weighing, change); !status) return status;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  return report;
}

RefitJob::RefitJob(std::shared_ptr<tear::RefitWork> work) : work_(std::move(work)) {}

Result<RefitJob> RefitJob::create(TornModel& model, const WeightsOperation& wanted) {
  TornModel::State& state = *model.state_;
  if (Status status = state.may_begin(); !status) return status;
  if (wanted.weights.policy != WeightPolicy::refit)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "only the policy 'refit' is fitted by a job");
  WeightsOperation resolved = wanted;
  if (Status status = state.resolve(resolved); !status) return status;
  resolved.pose = RestPose{};
  auto poses = PoseSet::create(state.source, wanted.refit.poses);
  if (!poses) return poses.error();
  try {
    const tear::VertexRanges ranges = state.vertices_of(resolved);
    const auto points = tear::weighable_points(ranges, state.editor);
    WeightReport report;
    tear::Weighing weighing = tear::weigh(points, wanted.weights, {}, {}, state.editor, report);
    auto work = std::make_shared<tear::RefitWork>(
        state.source, std::move(resolved), std::move(*poses), std::move(weighing),
        state.history.done()[wanted.first_operation]->begin, state.editor);
    work->report = report;
    const auto& done = state.history.done();
    for (std::uint32_t i = 0; i < work->operation.operation_count; ++i)
      work->serials.push_back(done[work->operation.first_operation + i]->serial);
    std::erase_if(state.refits,
                  [](const std::weak_ptr<tear::RefitWork>& refit) { return refit.expired(); });
    state.refits.push_back(work);
    return RefitJob(std::move(work));
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

void RefitJob::run() const { work_->run(); }

RefitJob::State RefitJob::poll() const { return work_->state; }

void RefitJob::cancel() const { work_->cancel(); }

const Status& RefitJob::failure() const { return work_->failure; }

Result<WeightReport> RefitJob::swap_in(TornModel& model, ChangeRecord* change) const {
  TornModel::State& of_model = *model.state_;
  if (Status status = of_model.may_begin(); !status) return status;
  const WeightsOperation& operation = work_->operation;
  if (work_->state == State::cancelled)
    return Status::failure(StatusCode::invalid_argument, kNone, "this refit was cancelled");
  if (work_->state != State::done)
    return Status::failure(StatusCode::invalid_argument, kNone, "this refit is not done");
  const auto& done = of_model.history.done();
  for (std::size_t i = 0; i < work_->serials.size(); ++i)
    if (operation.first_operation + i >= done.size() ||
        done[operation.first_operation + i]->serial != work_->serials[i])
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "this refit is of another model, or of operations undone since");
  if (Status status = of_model.reweigh(operation, work_->weighing, change); !status) return status;
  work_->state = State::swapped_in;
  return work_->report;
}

}  // namespace sunder
