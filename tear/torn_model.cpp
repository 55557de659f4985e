#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <new>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "tear/detached/released_vertices.h"
#include "tear/internal/surface.h"
#include "tear/model/growth.h"
#include "tear/model/instance.h"
#include "tear/model/model_state.h"
#include "tear/operation/cut.h"
#include "tear/operation/drill.h"
#include "tear/operation/ongoing_stroke.h"
#include "tear/pieces/describe_piece.h"
#include "tear/surface/compact.h"
#include "tear/surface/weight_change.h"
#include "tear/suture/suture.h"
#include "tear/weld/weld.h"

namespace sunder {
Result<TornModel> TornModel::create(std::shared_ptr<const Character> source,
                                    const TornCapacity& capacity) {
  if (!source) return Status::failure(StatusCode::empty_input, kNone, "the character is null");
  if (Status status = validate_character(*source); !status) return status;
  if (Status status = check_size(*source, capacity); !status) return status;
  try {
    TornModel model(
        std::make_unique<Instance>(TornAsset::Parts::make_private(std::move(source)), capacity));
    if (Status status = model.unpack(); !status) return status;
    return model;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Result<TornModel> TornModel::create(std::shared_ptr<const TornAsset> asset,
                                    const TornCapacity& capacity) {
  if (!asset) return Status::failure(StatusCode::empty_input, kNone, "the asset is null");
  if (Status status = check_size(*asset->character(), capacity); !status) return status;
  try {
    return TornModel(std::make_unique<Instance>(std::move(asset), capacity));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

TornModel::TornModel(std::unique_ptr<Instance> instance) : state_{std::move(instance)} {}
TornModel::TornModel(TornModel&&) noexcept = default;
TornModel& TornModel::operator=(TornModel&&) noexcept = default;
TornModel::~TornModel() = default;

Result<TearReport> TornModel::tear(const ModelPose& pose, std::span<const Blade> stroke,
                                   const TearOptions& options, ChangeRecord* change) {
  if (Status status = unpack(); !status) return status;
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = validate_tear(stroke, options); !status) return status;
  const WeightOptions weights = options.weights.value_or(state.weights);
  const auto write_entry = [&](TearOperation& entry) {
    entry.stroke.assign(stroke.begin(), stroke.end());
    entry.options = options;
    entry.options.weights = recorded(weights, state.weights);
  };
  const auto work = [&](tear::Outcome& outcome) {
    state.stroke.begin(stroke.front(), options);
    for (const Blade& blade : stroke.subspan(1)) {
      state.stroke.extend(blade, state.workpiece(), outcome);
      tear::check_growth(state.capacity, *state.source, state.character);
    }
    state.stroke.finish(state.workpiece(), outcome);
  };
  return state.perform<TearOperation>({pose, weights, change, options.wall_depth > 0}, write_entry,
                                      work);
}

Result<TearReport> TornModel::cut(const ModelPose& pose, const PlaneCut& cut,
                                  ChangeRecord* change) {
  if (Status status = unpack(); !status) return status;
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = tear::validate_cut(cut, state.character.skeleton); !status) return status;
  const WeightOptions weights = cut.weights.value_or(state.weights);
  if (Status status = validate_weights(weights); !status) return status;
  const auto write_entry = [&](CutOperation& entry) {
    entry.cut = cut;
    entry.cut.weights = recorded(weights, state.weights);
  };
  const auto work = [&](tear::Outcome& outcome) {
    tear::cut_surface(cut, state.workpiece(), outcome);
  };
  return state.perform<CutOperation>({pose, weights, change, false, true}, write_entry, work);
}

Result<TearReport> TornModel::drill(const ModelPose& pose, const Bore& bore, ChangeRecord* change) {
  if (Status status = unpack(); !status) return status;
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = tear::validate_bore(bore); !status) return status;
  const WeightOptions weights = bore.weights.value_or(state.weights);
  if (Status status = validate_weights(weights); !status) return status;
  const auto write_entry = [&](DrillOperation& entry) {
    entry.bore = bore;
    entry.bore.weights = recorded(weights, state.weights);
  };
  const auto work = [&](tear::Outcome& outcome) {
    tear::drill_surface(bore, state.workpiece(), outcome);
  };
  return state.perform<DrillOperation>({pose, weights, change, bore.wall}, write_entry, work);
}

Result<TearReport> TornModel::weld(const ModelPose& pose, const Weld& weld, ChangeRecord* change) {
  if (Status status = unpack(); !status) return status;
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = tear::validate_weld(weld); !status) return status;
  const auto write_entry = [&](WeldOperation& entry) { entry.weld = weld; };
  const auto work = [&](tear::Outcome& outcome) {
    tear::weld_surface(weld, state.workpiece(), outcome);
  };
  return state.perform<WeldOperation>({pose, state.weights, change}, write_entry, work);
}

Result<TearReport> suture(TornModel& model, const ModelPose& pose, const Suture& suture,
                          ChangeRecord* change) {
  if (Status status = model.unpack(); !status) return status;
  TornModel::State& state = *model.state_;
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = tear::validate_suture(suture); !status) return status;
  const auto write_entry = [&](SutureOperation& entry) { entry.suture = suture; };
  const auto work = [&](tear::Outcome& outcome) {
    tear::tie_threads(suture, state.workpiece(), outcome);
  };
  return state.perform<SutureOperation>({pose, state.weights, change}, write_entry, work);
}

Result<PieceDescription> TornModel::describe_piece(const TornPiece& piece) const {
  if (Status status = unpack(); !status) return status;
  const auto& meshes = character().meshes;
  if (piece.mesh >= meshes.size() || piece.triangle >= meshes[piece.mesh].triangle_count())
    return Status::failure(StatusCode::index_out_of_range, piece.triangle,
                           "the model has no triangle %u in a mesh %u", piece.triangle, piece.mesh);
  State& state = *state_;
  const std::uint32_t face = state.editor.origins.surface_triangle(piece.mesh, piece.triangle);
  if (!state.posed.has_pose() || state.editor.surface().has_repeated_point(face))
    return Status::failure(StatusCode::not_found, piece.triangle,
                           "triangle %u of mesh %u is in no piece", piece.triangle, piece.mesh);
  try {
    return tear::describe_piece(face, state.editor, state.posed);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status TornModel::undo(ChangeRecord* change) {
  if (Status status = unpack(); !status) return status;
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
      tear::VerticesOfMeshes returned;
      const bool tells =
          change != nullptr && std::holds_alternative<DetachOperation>(last.operation);
      if (tells) returned = tear::released_vertices(last.begin, state.editor);
      state.editor.undo(last.begin, last.redo, change);
      if (tells) tear::put_returned(returned, *change);
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
  if (Status status = unpack(); !status) return status;
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
      tear::VerticesOfMeshes released;
      const bool tells =
          change != nullptr && std::holds_alternative<DetachOperation>(last.operation);
      if (tells) released = tear::released_vertices(last.redo, state.editor);
      state.editor.redo(last.redo, change);
      if (tells) tear::put_released(released, *change);
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
  (is_packed() ? state_.instance->weights : state_->weights) = options;
  return {};
}

const WeightOptions& TornModel::weights() const {
  return is_packed() ? state_.instance->weights : state_->weights;
}

namespace {

using Entries = std::vector<std::unique_ptr<tear::History::Entry>>;

/// The operations that are done, or were undone, in a history that may be null.
std::span<const Entries::value_type> entries_of(const tear::History* history,
                                                const Entries& (tear::History::*which)() const) {
  if (history == nullptr) return {};
  return (history->*which)();
}

}  // namespace

const TornModel::State* TornModel::torn_state() const { return state_.instance->torn(); }

WeightPolicy TornModel::weight_policy(std::uint32_t mesh, std::uint32_t vertex) const {
  SUNDER_ASSERT(mesh < character().meshes.size() &&
                vertex < character().meshes[mesh].vertex_count());
  const State* const torn = torn_state();
  return torn == nullptr ? WeightPolicy::barycentric : torn->editor.births.policy(mesh, vertex);
}

const InfluencePositions& TornModel::influence_positions(std::uint32_t mesh) const {
  static const InfluencePositions none;
  SUNDER_ASSERT(mesh < character().meshes.size());
  const State* const torn = torn_state();
  return torn == nullptr ? none : torn->editor.exact.of(mesh);
}

std::uint32_t TornModel::influence_place(std::uint32_t mesh, std::uint32_t vertex) const {
  SUNDER_ASSERT(mesh < character().meshes.size() &&
                vertex < character().meshes[mesh].vertex_count());
  if (weight_policy(mesh, vertex) != WeightPolicy::exact) return kNone;
  const auto& vertices = state_->editor.exact.of(mesh).vertices;
  if (!std::binary_search(vertices.begin(), vertices.end(), vertex)) return kNone;
  return static_cast<std::uint32_t>(state_->editor.exact.place(mesh, vertex));
}

std::uint32_t TornModel::undo_count() const {
  return state_.instance->read_history([](const tear::History* history) {
    return static_cast<std::uint32_t>(entries_of(history, &tear::History::done).size());
  });
}
std::uint32_t TornModel::redo_count() const {
  return state_.instance->read_history([](const tear::History* history) {
    return static_cast<std::uint32_t>(entries_of(history, &tear::History::undone).size());
  });
}

std::uint64_t TornModel::newest_operation() const {
  return state_.instance->read_history([](const tear::History* history) -> std::uint64_t {
    const auto done = entries_of(history, &tear::History::done);
    return done.empty() ? 0 : done.back()->serial;
  });
}

bool TornModel::is_in_stroke() const { return !is_packed() && state_->has_stroke; }

Result<std::vector<Operation>> TornModel::undone_operations() const {
  try {
    return state_.instance->read_history([](const tear::History* history) {
      std::vector<Operation> operations;
      for (const auto& entry : entries_of(history, &tear::History::undone))
        operations.insert(operations.begin(), entry->operation);
      return operations;
    });
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Result<std::vector<Operation>> TornModel::history() const {
  try {
    return state_.instance->read_history([](const tear::History* history) {
      std::vector<Operation> operations;
      for (const auto& entry : entries_of(history, &tear::History::done))
        operations.push_back(entry->operation);
      return operations;
    });
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Result<CompactMaps> TornModel::compact() {
  if (Status status = unpack(); !status) return status;
  if (Status status = state_->may_begin(); !status) return status;
  try {
    auto source = std::make_shared<Character>(state_->character);
    CompactMaps maps = sunder::compact(*source);
    auto compacted = std::make_unique<Instance>(TornAsset::Parts::make_private(std::move(source)),
                                                state_->capacity);
    compacted->weights = state_->weights;
    (void)compacted->unpacked();
    for (const auto& refit : state_->refits)
      if (const auto work = refit.lock()) work->cancel();
    state_.instance = std::move(compacted);
    return maps;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

const Character& TornModel::character() const {
  const State* const torn = torn_state();
  return torn == nullptr ? source() : torn->character;
}
const Character& TornModel::source() const { return *state_.instance->parts().character; }
const tear::Surface& TornModel::surface() const {
  const State* const torn = torn_state();
  return torn == nullptr ? state_.instance->parts().surface : torn->editor.surface();
}
std::uint32_t TornModel::point_count() const { return surface().point_count(); }

std::uint32_t TornModel::point_at(std::uint32_t mesh, std::uint32_t triangle,
                                  std::uint32_t corner) const {
  SUNDER_ASSERT(mesh < character().meshes.size() &&
                triangle < character().meshes[mesh].triangle_count());
  SUNDER_ASSERT(corner < 3);
  const State* const torn = torn_state();
  const std::uint32_t of_surface = torn == nullptr
                                       ? surface().first_triangle[mesh] + triangle
                                       : torn->editor.origins.surface_triangle(mesh, triangle);
  return surface().corner_point[3 * of_surface + corner];
}

Birth TornModel::birth(std::uint32_t mesh, std::uint32_t vertex) const {
  SUNDER_ASSERT(mesh < character().meshes.size() &&
                vertex < character().meshes[mesh].vertex_count());
  return state_->editor.births.at(mesh, vertex);
}

std::uint32_t TornModel::source_triangle(std::uint32_t mesh, std::uint32_t triangle) const {
  SUNDER_ASSERT(mesh < character().meshes.size() &&
                triangle < character().meshes[mesh].triangle_count());
  const State* const torn = torn_state();
  if (torn == nullptr) return triangle;
  return torn->editor.surface()
      .triangle(torn->editor.origins.surface_triangle(mesh, triangle))
      .source_triangle;
}

std::span<const Triangle> TornModel::fillings(std::uint32_t mesh) const {
  SUNDER_ASSERT(mesh < character().meshes.size());
  const State* const torn = torn_state();
  return torn == nullptr ? std::span<const Triangle>() : torn->editor.fillings.of(mesh);
}

}  // namespace sunder
