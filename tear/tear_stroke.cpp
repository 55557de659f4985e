#include <sunder/tear/tear_stroke.h>

#include <cmath>
#include <new>
#include <utility>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "core/operation/internal/field_ranges.h"
#include "skinning/internal/same_bits.h"
#include "tear/geometry/tolerances.h"
#include "tear/model/model_state.h"
#include "tear/operation/ongoing_stroke.h"
#include "tear/surface/describe_change.h"

namespace sunder {
namespace {

bool same_bits(const ModelPose& a, const ModelPose& b) {
  if (a.model_from_bone.size() != b.model_from_bone.size() || a.morph_weights != b.morph_weights)
    return false;
  for (std::size_t i = 0; i < a.model_from_bone.size(); ++i)
    if (!has_same_bits(a.model_from_bone[i], b.model_from_bone[i])) return false;
  return true;
}

Status validate_sampling(const StrokeSampling& sampling) {
  if (Status status = field::kMinimumDistance.check(sampling.minimum_distance); !status)
    return status;
  return field::kMinimumSeconds.check(sampling.minimum_seconds);
}

/// The report of a stroke is the sum of its calls' reports, except the figures that are counted
/// over the whole stroke.
void add_to(TearReport& sum, const TearReport& report) {
  sum.runs += report.runs;
  sum.segments += report.segments;
  sum.segments_missed += report.segments_missed;
  sum.faces_crossed += report.faces_crossed;
  sum.blocked += report.blocked;
  sum.length_posed += report.length_posed;
  sum.area_removed_posed += report.area_removed_posed;
  sum.weights.points += report.weights.points;
  sum.weights.ill_conditioned += report.weights.ill_conditioned;
  sum.weights.pruned += report.weights.pruned;
}

}  // namespace

struct TearStroke::State {
  /// A blade that the sampling holds back, and its pose.
  struct Held {
    ModelPose pose;
    Blade blade;
  };

  TornModel::State* model;
  StrokeSampling sampling;
  tear::History::Entry& entry;  ///< The next entry of the history.
  TearOperation& operation;     ///< The stroke so far, in that entry.
  double last_seconds = 0;
  std::optional<Held> held = {};
  tear::EditLog::Mark begin = {};
  TearReport total = {};
  /// Points from this index on were made in the current pose of the model.
  Index first_in_pose = 0;
  // The state to which a failed call returns, with TornModel::State::stroke_before.
  ModelPose pose_before = {};
  /// Points with their posed positions in that pose, if the pose was left.
  std::vector<std::pair<Index, Vec3d>> found_before = {};
  /// Once it is true the model is not used any more: it may be destroyed or have another stroke.
  bool has_ended = false;

  [[nodiscard]] bool is_due(const Blade& blade, double seconds) const {
    const Blade& last = model->stroke.blade();
    const double moved = std::max(norm(blade.base - last.base), norm(blade.tip - last.tip));
    return moved >= sampling.minimum_distance && seconds - last_seconds >= sampling.minimum_seconds;
  }

  /// Ends the stroke: it is no longer under way.
  void close() {
    model->has_stroke = false;
    has_ended = true;
  }

  /// Extends the stroke by a blade, within a call.
  Status take_up(const ModelPose& pose, const Blade& blade, tear::Outcome& outcome) {
    const auto index = static_cast<std::uint32_t>(operation.stroke.size());
    if (!same_bits(pose, model->pose)) {
      // In another pose, and in this one when it is entered again, these points are at the
      // positions given by their weights.
      for (Index point = first_in_pose; point < model->editor.surface().point_count(); ++point)
        if (const Vec3d* found = model->posed.find_known(point))
          found_before.emplace_back(point, *found);
      model->stroke.leave_pose(model->workpiece(), outcome);
      const Index points = model->editor.surface().point_count();
      if (Status status = model->stand_in(pose); !status) return status;
      first_in_pose = points;
      model->stroke.enter_pose(model->workpiece());
      entry.add_pose_change(index, pose);
    }
    operation.stroke.push_back(blade);
    model->stroke.extend(blade, model->workpiece(), outcome);
    return {};
  }

  /// Runs `work`, then `conclude` with the report. If either fails everything is restored, the pose
  /// too.
  template <class Work, class Conclude>
  Result<TearReport> call(Work work, ChangeRecord* change, Conclude conclude) {
    try {
      model->stroke_before = model->stroke;
      pose_before = model->pose;
    } catch (const std::bad_alloc&) {
      return out_of_memory();
    }
    found_before.clear();
    const Index first_before = first_in_pose;
    const std::size_t blades = operation.stroke.size(), poses = operation.pose_changes.size();
    const WeightOptions weights = operation.options.weights.value_or(WeightOptions{});
    auto report = model->call({weights, change}, work, conclude);
    if (report) return report;
    std::swap(model->stroke, model->stroke_before);
    operation.stroke.resize(blades);
    entry.drop_pose_changes(poses);
    first_in_pose = first_before;
    if (!same_bits(pose_before, model->pose)) {
      (void)model->stand_in(pose_before);
      for (const auto& [point, found] : found_before) model->posed.pin(point, found);
    }
    return report;
  }
};

TearStroke::TearStroke(std::unique_ptr<State> state) : state_(std::move(state)) {}
TearStroke::TearStroke(TearStroke&&) noexcept = default;

TearStroke::~TearStroke() {
  if (state_ && !state_->has_ended) (void)cancel();
}

Result<TearStroke> TearStroke::create(TornModel& model, const ModelPose& pose, const Blade& blade,
                                      const TearOptions& options, const StrokeSampling& sampling) {
  if (Status status = model.unpack(); !status) return status;
  TornModel::State& of_model = *model.state_;
  if (Status status = of_model.may_begin(); !status) return status;
  if (Status status = validate_options(options); !status) return status;
  if (Status status = validate_sampling(sampling); !status) return status;
  if (Status status = validate_blade(blade, 0); !status) return status;
  if (Status status = of_model.stand_in(pose); !status) return status;
  try {
    tear::History::Entry& entry = of_model.history.next();
    auto& operation = entry.as<TearOperation>();
    tear::assign_pose(pose, operation.pose);
    operation.stroke.assign(1, blade);
    operation.options = options;
    operation.options.weights =
        recorded(options.weights.value_or(of_model.weights), of_model.weights);
    of_model.stroke.begin(blade, options);
    auto state = std::unique_ptr<State>(new State{&of_model, sampling, entry, operation});
    entry.begin = state->begin = of_model.begin_operation(options.wall_depth > 0);
    state->first_in_pose = state->begin.points;
    of_model.has_stroke = true;
    return TearStroke(std::move(state));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Result<TearReport> TearStroke::extend(const ModelPose& pose, const Blade& blade, double seconds,
                                      ChangeRecord* change) {
  State& state = *state_;
  if (state.has_ended)
    return Status::failure(StatusCode::invalid_argument, kNone, "this stroke has ended");
  const auto index = static_cast<std::uint32_t>(state.operation.stroke.size());
  if (Status status = validate_blade(blade, index); !status) return status;
  if (!std::isfinite(seconds) || seconds < state.last_seconds)
    return Status::failure(
        StatusCode::invalid_argument, index,
        "blade %u is at %g s; its time must be finite and not before the previous one, at %g s",
        index, seconds, state.last_seconds);
  if (Status status = validate_turn(state.model->stroke.blade(), blade, index); !status)
    return status;
  if (!state.is_due(blade, seconds)) {
    if (Status status = CharacterPose::check(state.model->character, pose); !status) return status;
    try {
      state.held = State::Held{pose, blade};
    } catch (const std::bad_alloc&) {
      return out_of_memory();
    }
    if (change != nullptr) *change = {};
    return TearReport{};
  }
  auto report =
      state.call([&](tear::Outcome& outcome) { return state.take_up(pose, blade, outcome); },
                 change, [](const TearReport&) {});
  if (!report) return report;
  add_to(state.total, *report);
  state.last_seconds = seconds;
  state.held.reset();
  return report;
}

Result<TearReport> TearStroke::end(ChangeRecord* change) {
  State& state = *state_;
  if (state.has_ended)
    return Status::failure(StatusCode::invalid_argument, kNone, "this stroke has ended");
  TearReport total = state.total;
  const auto report = state.call(
      [&](tear::Outcome& outcome) -> Status {
        if (state.held)
          if (Status status = state.take_up(state.held->pose, state.held->blade, outcome); !status)
            return status;
        state.model->stroke.finish(state.model->workpiece(), outcome);
        return {};
      },
      change,
      [&](const TearReport& last) {
        add_to(total, last);
        state.model->count_changes_since(state.begin, total);
        total.pieces = state.model->find_pieces_since(state.begin);
      });
  if (!report) return report;
  state.close();
  // A stroke of one blade tears nothing, so there is nothing to undo.
  if (state.operation.stroke.size() > 1) state.model->record(state.begin);
  return total;
}

Status TearStroke::cancel(ChangeRecord* change) {
  State& state = *state_;
  if (state.has_ended)
    return Status::failure(StatusCode::invalid_argument, kNone, "this stroke has ended");
  TornModel::State& model = *state.model;
  try {
    model.editor.scratch().reset();
    if (change != nullptr) tear::describe_roll_back(state.begin, model.editor, *change);
  } catch (const tear::CapacityExceeded& exceeded) {
    return model.no_room(exceeded);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
  model.editor.roll_back(state.begin);
  model.posed.forget_from(state.begin.points);
  state.close();
  return {};
}

}  // namespace sunder
