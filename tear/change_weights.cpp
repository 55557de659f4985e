// Changes the weights of points that earlier operations created.

#include <sunder/skinning/pose.h>
#include <sunder/tear/refit_job.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "core/internal/out_of_memory.h"
#include "core/operation/internal/field_ranges.h"
#include "skinning/internal/character_pose.h"
#include "tear/model/model_state.h"
#include "tear/surface/weight_change.h"

namespace sunder {

Status TornModel::State::resolve(WeightsOperation& wanted) const {
  if (Status status = validate_weights(wanted.weights); !status) return status;
  const auto done = static_cast<std::uint32_t>(history.done().size());
  if (wanted.first_operation >= done)
    return Status::failure(
        StatusCode::not_found, wanted.first_operation,
        "weights are requested from operation %u on; the model has %u operations",
        wanted.first_operation, done);
  if (wanted.operation_count == kNone) wanted.operation_count = done - wanted.first_operation;
  if (wanted.operation_count == 0 || wanted.operation_count > done - wanted.first_operation)
    return Status::failure(
        StatusCode::not_found, wanted.first_operation,
        "weights are requested for %u operations from operation %u on; the model has %u operations",
        wanted.operation_count, wanted.first_operation, done);
  if (wanted.weights.policy != WeightPolicy::refit) return {};
  if (Status status = field::kSmoothness.check(wanted.refit.smoothness); !status) return status;
  if (wanted.refit.is_coupled && !has_coupled_refit())
    return refit_coupled({}, {}, {}, PoseMoments(1, Vec3d::Zero())).error();
  return {};
}

tear::VertexRanges TornModel::State::vertices_of(const WeightsOperation& resolved) const {
  const auto& done = history.done();
  const std::vector<std::uint32_t> first =
      editor.log.vertex_counts_at(done[resolved.first_operation]->begin);
  const std::size_t after = std::size_t{resolved.first_operation} + resolved.operation_count;
  const std::vector<std::uint32_t> end = after < done.size()
                                             ? editor.log.vertex_counts_at(done[after]->begin)
                                             : std::vector<std::uint32_t>();
  tear::VertexRanges ranges;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh)
    ranges.push_back(
        {first[mesh], end.empty() ? character.meshes[mesh].vertex_count() : end[mesh]});
  return ranges;
}

Status TornModel::State::reweigh(const WeightsOperation& resolved,
                                 const tear::WeightAssignment& assignment, ChangeRecord* change) {
  const tear::EditLog::Mark begin = editor.mark();
  try {
    tear::History::Entry& entry = history.next();
    entry.as<WeightsOperation>() = resolved;
    entry.begin = begin;
    entry.weights = tear::make_weight_change(assignment, vertices_of(resolved), editor);
    if (change != nullptr) tear::describe_weights(entry.weights, editor, *change);
    tear::exchange_weights(entry.weights, editor);  // last, because it cannot be rolled back
  } catch (const tear::CapacityExceeded& exceeded) {
    editor.roll_back(begin);
    return no_room(exceeded);
  } catch (const std::bad_alloc&) {
    editor.roll_back(begin);
    return out_of_memory();
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
  if (Status status = unpack(); !status) return status;
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  try {
    WeightsOperation resolved = wanted;
    if (Status status = state.resolve(resolved); !status) return status;
    auto pose = make_pose(state.character, wanted.pose);
    if (!pose) return pose.error();
    CharacterPose palettes;
    if (Status status = palettes.set(state.character, *pose); !status) return status;
    resolved.pose = std::move(*pose);
    WeightReport report;
    const auto points = tear::interpolated_points(state.vertices_of(resolved), state.editor);
    const tear::WeightAssignment assignment =
        tear::compute_weights(points, wanted.weights, palettes, state.editor, report);
    if (Status status = state.reweigh(resolved, assignment, change); !status) return status;
    return report;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

}  // namespace sunder
