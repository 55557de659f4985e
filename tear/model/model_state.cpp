#include "tear/model/model_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/internal/ordered.h"
#include "core/operation/internal/check_ranges.h"
#include "core/operation/internal/describe_operations.h"
#include "tear/detached/released_vertices.h"
#include "tear/geometry/tolerances.h"
#include "tear/model/growth.h"
#include "tear/pieces/pieces.h"
#include "tear/surface/copy_with_room.h"
#include "tear/surface/describe_change.h"
#include "tear/weights/assign_weights.h"

namespace sunder {

TornModel::State::State(std::shared_ptr<const Character> from, tear::Surface surface,
                        const tear::SourceTrees& trees, const TornCapacity& of,
                        std::shared_ptr<const tear::SurfaceCells> cells)
    : source(std::move(from)),
      capacity(of),
      character(tear::copy_with_room(*source, of)),
      editor(*source, character, std::move(surface), of) {
  posed.forest().share(trees);
  if (cells) editor.changed_cells.share(std::move(cells));
  editor.reserve(capacity);
  untorn_ = editor.mark();
  if (!editor.room.is_fixed()) return;
  pose.model_from_bone.resize(character.skeleton.bones.size());
  pose.morph_weights.resize(character.rest_morph_weights.size());
  posed.cover(editor.surface().point_count() + capacity.vertices);
  for (auto* lips : {&borders_.of_call.lips, &borders_.of_operation.lips})
    lips->reserve(most_lips());
  history = new_history();
}

tear::History TornModel::State::new_history() const {
  tear::History empty;
  if (!editor.room.is_fixed()) return empty;
  ModelPose of_any;
  of_any.model_from_bone.resize(character.skeleton.bones.size());
  of_any.morph_weights.resize(character.rest_morph_weights.size());
  empty.limit_to(capacity.operations, most_lips(), of_any);
  return empty;
}

std::unique_ptr<tear::PackedOperations> TornModel::State::pack() {
  auto packed = std::make_unique<tear::PackedOperations>();
  tear::History empty = new_history();
  editor.undo(untorn_, packed->change, nullptr);  // nothing fails from here on
  packed->change.shrink();
  packed->history = std::exchange(history, std::move(empty));
  packed->history.shrink();
  packed->refits = std::exchange(refits, {});
  return packed;
}

void TornModel::State::unpack(tear::PackedOperations& packed) {
  history.make_room_for(packed.history);
  editor.scratch().reset();
  editor.redo(packed.change, nullptr);  // nothing fails from here on
  history.adopt(packed.history);
  refits = std::move(packed.refits);
}

bool TornModel::State::reset() noexcept {
  try {
    if (!history.is_empty()) history = new_history();
  } catch (const std::bad_alloc&) {
    return false;
  }
  editor.roll_back(untorn_);
  refits.clear();
  has_stroke = false;
  return true;
}

Status TornModel::State::may_begin() const {
  if (has_stroke)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "a stroke is in progress; end or cancel it first");
  return history.has_room() ? Status() : no_room({"operations"});
}

Status TornModel::State::no_room(const tear::CapacityExceeded& exceeded) const {
  if (tear::is_limit(capacity))
    return Status::failure(StatusCode::capacity_exceeded, kNone,
                           "no room left for %s: operations may add %u vertices and %u triangles "
                           "to a mesh",
                           exceeded.what, capacity.vertices, capacity.triangles);
  return Status::failure(StatusCode::capacity_exceeded, kNone,
                         "no room left for %s: the model was made for %u more vertices, %u more "
                         "triangles and %u operations",
                         exceeded.what, capacity.vertices, capacity.triangles, capacity.operations);
}

Status TornModel::State::stand_in(const ModelPose& wanted) {
  try {
    pose.model_from_bone.reserve(wanted.model_from_bone.size());
    pose.morph_weights.reserve(wanted.morph_weights.size());
    if (Status status = posed.begin(character, wanted); !status) return status;
    pose = wanted;
    return {};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

void TornModel::State::cancel_refits_of(std::uint64_t serial) const {
  for (const auto& refit : refits)
    if (const auto work = refit.lock();
        work &&
        std::ranges::any_of(work->operations, [&](const auto& of) { return of.serial == serial; }))
      work->cancel();
}

void TornModel::State::begin_call() {
  editor.scratch().reset();
  borders_.of_call.clear();
  begin_of_call_ = editor.mark();
}

WeightReport TornModel::State::weigh_points_since(const tear::EditLog::Mark& begin,
                                                  const WeightOptions& options) {
  WeightReport report;
  tear::assign_new_weights(begin, options, posed.pose(), editor, report);
  return report;
}

void TornModel::State::describe_call(ChangeRecord& change, bool is_detachment) {
  tear::describe_change(begin_of_call_, editor, change);
  if (is_detachment) {
    tear::VerticesOfMeshes released = tear::released_vertices(begin_of_call_, editor);
    tear::put_released(released, change);
  }
  change.lips = borders_.of_call.lips;
  tear::settle_rims(tear::sort_rim_points(borders_.of_call.rim_points, editor.scratch()),
                    editor.surface(), change.rims);
}

/// Reserves memory, so that keep_borders() and record() do not fail, and checks the limit of what
/// operations add.
void TornModel::State::make_room_for_borders() {
  tear::check_growth(capacity, *source, character);
  const auto& [lips, rim_points] = borders_.of_call;
  tear::make_room_to_hold(borders_.of_operation.lips.size() + lips.size(),
                          borders_.of_operation.lips);
  tear::make_room_to_hold(borders_.of_operation.rim_points.size() + rim_points.size(),
                          borders_.of_operation.rim_points);
  history.make_room_for(borders_.of_operation.lips.size() + lips.size(),
                        borders_.of_operation.rim_points.size() + rim_points.size());
}

void TornModel::State::drop_removed_lips() {
  const std::vector<Index>& corners = editor.surface().point_corner;
  std::erase_if(borders_.of_call.lips, [&](const LipPair& lip) {
    return corners[lip.left] == kNone || corners[lip.right] == kNone;
  });
}

void TornModel::State::keep_borders() {
  const auto& [lips, rim_points] = borders_.of_call;
  borders_.of_operation.lips.insert(borders_.of_operation.lips.end(), lips.begin(), lips.end());
  borders_.of_operation.rim_points.insert(borders_.of_operation.rim_points.end(),
                                          rim_points.begin(), rim_points.end());
}

void TornModel::State::take_back() {
  editor.roll_back(begin_of_call_);
  posed.forget_from(begin_of_call_.points);
}

void TornModel::State::count_changes_since(const tear::EditLog::Mark& begin,
                                           TearReport& report) const {
  report.points_added = editor.surface().point_count() - begin.points;
  report.triangles_added = editor.surface().triangle_count() - begin.triangles;
  report.vertices_added = editor.log.vertices_since(begin);
  report.triangles_retired = 0;
  editor.log.for_each_changed(begin, [&](std::uint32_t triangle) {
    report.triangles_retired += editor.surface().corner_point[3 * triangle] == kNone ? 1 : 0;
  });
}

TornPieces TornModel::State::find_pieces_since(const tear::EditLog::Mark& begin) {
  return tear::find_pieces(begin, editor.log.extent(), editor);
}

TornPieces TornModel::State::find_pieces_of_call(bool names_all, const tear::Outcome& outcome) {
  if (names_all) return tear::find_pieces_at(borders_.of_call.lips, editor);
  // Walls separate nothing.
  return tear::find_pieces(begin_of_call_, outcome.before_walls.value_or(editor.log.extent()),
                           editor);
}

void TornModel::State::record(const tear::EditLog::Mark& begin) {
  const bool has_threads = editor.connectivity.threads().size() > begin.threads;
  if (editor.log.numbers_since(begin) == 0 && !has_threads) return;  // nothing changed
  history.filled().begin = begin;
  history.push(borders_.of_operation);
  editor.drop_inner_changes(begin);
}

Status validate_blade(const Blade& blade, std::uint32_t index) {
  if (!blade.base.allFinite() || !blade.tip.allFinite())
    return Status::failure(StatusCode::non_finite_value, index, "blade %u is not finite", index);
  if (blade.base.cwiseAbs().maxCoeff() > tear::kFarthestMetres ||
      blade.tip.cwiseAbs().maxCoeff() > tear::kFarthestMetres)
    return Status::failure(StatusCode::invalid_argument, index, "blade %u lies beyond 1e60", index);
  if (!(norm(blade.tip - blade.base) > tear::kShortestMetres))
    return Status::failure(StatusCode::invalid_argument, index,
                           "blade %u has no length: its base equals its tip", index);
  return {};
}

Status validate_turn(const Blade& before, const Blade& blade, std::uint32_t index) {
  if (dot(normalized(blade.tip - blade.base), normalized(before.tip - before.base)) > 0) return {};
  return Status::failure(StatusCode::invalid_argument, index,
                         "blade %u is turned by 90 degrees or more relative to the one before it; "
                         "sample the stroke more finely",
                         index);
}

Status validate_weights(const WeightOptions& options) {
  if (options.policy > WeightPolicy::exact)
    return Status::failure(StatusCode::invalid_argument, kNone, "unknown weight policy %u",
                           static_cast<unsigned>(options.policy));
  if (options.policy == WeightPolicy::exact && options.maximum_influences != 0)
    return Status::failure(
        StatusCode::invalid_argument, kNone,
        "the policy 'exact' keeps all influences; maximum_influences is %u, it must be 0",
        options.maximum_influences);
  return {};
}

Status validate_options(const TearOptions& options) {
  if (Status status = check_ranges(options); !status) return status;
  return options.weights ? validate_weights(*options.weights) : Status();
}

Status validate_tear(std::span<const Blade> stroke, const TearOptions& options) {
  if (stroke.size() < 2)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "a stroke needs at least two blades, this one has %zu", stroke.size());
  if (Status status = validate_options(options); !status) return status;
  for (std::uint32_t i = 0; i < stroke.size(); ++i) {
    if (Status status = validate_blade(stroke[i], i); !status) return status;
    if (i == 0) continue;
    if (Status status = validate_turn(stroke[i - 1], stroke[i], i); !status) return status;
  }
  return {};
}

}  // namespace sunder
