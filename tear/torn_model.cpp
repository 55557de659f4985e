#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <new>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "tear/internal/surface.h"
#include "tear/model_state.h"
#include "tear/operation/cut.h"
#include "tear/operation/drill.h"
#include "tear/operation/ongoing_stroke.h"
#include "tear/surface/compact.h"
#include "tear/surface/weight_change.h"

namespace sunder {
namespace {

/// Corners have 32-bit indices; this leaves half of them for triangles that tears append.
constexpr std::size_t kMaximumTriangles = kNone / 6;

}  // namespace

Result<TornModel> TornModel::create(std::shared_ptr<const Character> source,
                                    const TornCapacity& capacity) {
  if (!source) return Status::failure(StatusCode::empty_input, kNone, "the character is null");
  if (Status status = validate_character(*source); !status) return status;
  std::size_t triangles = capacity.triangles;
  for (const Mesh& mesh : source->meshes) triangles += mesh.triangles.size();
  if (triangles > kMaximumTriangles || capacity.vertices > kMaximumTriangles ||
      capacity.operations > kMaximumTriangles)
    return Status::failure(
        StatusCode::limit_exceeded, kNone,
        "the model has %zu triangles, including the capacity; at most %zu are supported", triangles,
        kMaximumTriangles);
  try {
    return TornModel(std::make_unique<State>(std::move(source), capacity));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

TornModel::TornModel(std::unique_ptr<State> state) : state_(std::move(state)) {}
TornModel::TornModel(TornModel&&) noexcept = default;
TornModel& TornModel::operator=(TornModel&&) noexcept = default;
TornModel::~TornModel() = default;

Result<TearReport> TornModel::tear(const ModelPose& pose, std::span<const Blade> stroke,
                                   const TearOptions& options, ChangeRecord* change) {
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = validate_tear(stroke, options); !status) return status;
  const WeightOptions weights = options.weights.value_or(state.weights);
  const auto write_entry = [&](TearOperation& entry) {
    entry.stroke.assign(stroke.begin(), stroke.end());
    entry.options = options;
    entry.options.weights = recorded(weights);
  };
  const auto work = [&](tear::Outcome& outcome) {
    state.stroke.begin(stroke.front(), options);
    for (const Blade& blade : stroke.subspan(1))
      state.stroke.extend(blade, state.workpiece(), outcome);
    state.stroke.finish(state.workpiece(), outcome);
  };
  return state.perform<TearOperation>({pose, weights, change, options.wall_depth > 0}, write_entry,
                                      work);
}

Result<TearReport> TornModel::cut(const ModelPose& pose, const PlaneCut& cut,
                                  ChangeRecord* change) {
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = tear::validate_cut(cut); !status) return status;
  const WeightOptions weights = cut.weights.value_or(state.weights);
  if (Status status = validate_weights(weights); !status) return status;
  const auto write_entry = [&](CutOperation& entry) {
    entry.cut = cut;
    entry.cut.weights = recorded(weights);
  };
  const auto work = [&](tear::Outcome& outcome) {
    tear::cut_surface(cut, state.workpiece(), outcome);
  };
  return state.perform<CutOperation>({pose, weights, change, false, true}, write_entry, work);
}

Result<TearReport> TornModel::drill(const ModelPose& pose, const Bore& bore, ChangeRecord* change) {
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = tear::validate_bore(bore); !status) return status;
  const WeightOptions weights = bore.weights.value_or(state.weights);
  if (Status status = validate_weights(weights); !status) return status;
  const auto write_entry = [&](DrillOperation& entry) {
    entry.bore = bore;
    entry.bore.weights = recorded(weights);
  };
  const auto work = [&](tear::Outcome& outcome) {
    tear::drill_surface(bore, state.workpiece(), outcome);
  };
  return state.perform<DrillOperation>({pose, weights, change, bore.wall}, write_entry, work);
}

Status TornModel::undo(ChangeRecord* change) {
  State& state = *state_;
  if (state.has_stroke) return state.may_begin();
  if (state.history.done().empty())
    return Status::failure(StatusCode::not_found, kNone, "there is nothing to undo");
  tear::History::Entry& last = *state.history.done().back();
  try {
    state.editor.scratch().reset();
    state.history.make_room_to_undo();
    if (std::holds_alternative<WeightsOperation>(last.operation)) {
      if (change != nullptr) tear::describe_weights(last.weights, state.editor, *change);
      tear::exchange_weights(last.weights, state.editor);
    } else {
      state.history.give_memory_to(last.redo);
      state.editor.undo(last.begin, last.redo, change);
    }
  } catch (const tear::CapacityExceeded& exceeded) {
    return state.no_room(exceeded);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
  state.cancel_refits_of(last.serial);
  state.history.move_to_undone();
  return {};
}

Status TornModel::redo(ChangeRecord* change) {
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (state.history.undone().empty())
    return Status::failure(StatusCode::not_found, kNone, "there is nothing to redo");
  tear::History::Entry& last = *state.history.undone().back();
  try {
    // The memory for lips and rims is reserved before anything changes.
    state.editor.scratch().reset();
    tear::ScratchVector<std::uint64_t> rim_points(&state.editor.scratch());
    if (change != nullptr) {
      const auto lips = state.history.lips_of(last);
      const auto told = state.history.rim_points_of(last);
      rim_points = tear::sort_rim_points(told, state.editor.scratch());
      change->lips.assign(lips.begin(), lips.end());
      change->rims.left.reserve(told.size());
      change->rims.right.reserve(told.size());
    }
    last.begin = state.editor.mark();
    if (std::holds_alternative<WeightsOperation>(last.operation)) {
      if (change != nullptr) tear::describe_weights(last.weights, state.editor, *change);
      tear::exchange_weights(last.weights, state.editor);
    } else {
      state.editor.redo(last.redo, change);
      if (change != nullptr) tear::settle_rims(rim_points, state.editor.surface(), change->rims);
    }
  } catch (const tear::CapacityExceeded& exceeded) {
    return state.no_room(exceeded);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
  state.history.move_to_done();
  return {};
}

Status TornModel::set_weights(const WeightOptions& options) {
  if (Status status = validate_weights(options); !status) return status;
  state_->weights = options;
  return {};
}

const WeightOptions& TornModel::weights() const { return state_->weights; }

WeightPolicy TornModel::weight_policy(std::uint32_t mesh, std::uint32_t vertex) const {
  SUNDER_ASSERT(mesh < character().meshes.size() &&
                vertex < character().meshes[mesh].vertex_count());
  return state_->editor.births.policy(mesh, vertex);
}

const InfluencePositions& TornModel::influence_positions(std::uint32_t mesh) const {
  SUNDER_ASSERT(mesh < character().meshes.size());
  return state_->editor.exact.of(mesh);
}

std::uint32_t TornModel::influence_place(std::uint32_t mesh, std::uint32_t vertex) const {
  SUNDER_ASSERT(mesh < character().meshes.size() &&
                vertex < character().meshes[mesh].vertex_count());
  if (state_->editor.births.policy(mesh, vertex) != WeightPolicy::exact) return kNone;
  const auto& vertices = state_->editor.exact.of(mesh).vertices;
  if (!std::binary_search(vertices.begin(), vertices.end(), vertex)) return kNone;
  return static_cast<std::uint32_t>(state_->editor.exact.place(mesh, vertex));
}

std::uint32_t TornModel::undo_count() const {
  return static_cast<std::uint32_t>(state_->history.done().size());
}
std::uint32_t TornModel::redo_count() const {
  return static_cast<std::uint32_t>(state_->history.undone().size());
}

std::uint64_t TornModel::newest_operation() const {
  return state_->history.done().empty() ? 0 : state_->history.done().back()->serial;
}

bool TornModel::is_in_stroke() const { return state_->has_stroke; }

Result<std::vector<Operation>> TornModel::history() const {
  try {
    std::vector<Operation> operations;
    for (const auto& entry : state_->history.done()) operations.push_back(entry->operation);
    return operations;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Result<CompactMaps> TornModel::compact() {
  if (Status status = state_->may_begin(); !status) return status;
  try {
    auto source = std::make_shared<Character>(state_->character);
    CompactMaps maps = sunder::compact(*source);
    auto compacted = std::make_unique<State>(std::move(source), state_->capacity);
    compacted->weights = state_->weights;
    for (const auto& refit : state_->refits)
      if (const auto work = refit.lock()) work->cancel();
    state_ = std::move(compacted);
    return maps;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

const Character& TornModel::character() const { return state_->character; }
const Character& TornModel::source() const { return *state_->source; }
const tear::Surface& TornModel::surface() const { return state_->editor.surface(); }
std::uint32_t TornModel::point_count() const { return state_->editor.surface().point_count(); }

std::uint32_t TornModel::point_at(std::uint32_t mesh, std::uint32_t triangle,
                                  std::uint32_t corner) const {
  SUNDER_ASSERT(mesh < character().meshes.size() &&
                triangle < character().meshes[mesh].triangle_count());
  SUNDER_ASSERT(corner < 3);
  return state_->editor.surface()
      .corner_point[3 * state_->editor.origins.surface_triangle(mesh, triangle) + corner];
}

Birth TornModel::birth(std::uint32_t mesh, std::uint32_t vertex) const {
  SUNDER_ASSERT(mesh < character().meshes.size() &&
                vertex < character().meshes[mesh].vertex_count());
  return state_->editor.births.at(mesh, vertex);
}

std::uint32_t TornModel::source_triangle(std::uint32_t mesh, std::uint32_t triangle) const {
  SUNDER_ASSERT(mesh < character().meshes.size() &&
                triangle < character().meshes[mesh].triangle_count());
  return state_->editor.surface()
      .triangle(state_->editor.origins.surface_triangle(mesh, triangle))
      .source_triangle;
}

std::span<const Triangle> TornModel::fillings(std::uint32_t mesh) const {
  SUNDER_ASSERT(mesh < character().meshes.size());
  return state_->editor.fillings.of(mesh);
}

}  // namespace sunder
