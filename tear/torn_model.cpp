#include <sunder/tear/torn_model.h>

#include <new>

#include "tear/cut.h"
#include "tear/drill.h"
#include "tear/model_state.h"
#include "tear/stroke_tearing.h"

namespace sunder {
namespace {

/// Corners have 32-bit numbers; this leaves half of them to what tears append.
constexpr std::size_t kMaximumTriangles = kNone / 6;

}  // namespace

Result<TornModel> TornModel::create(std::shared_ptr<const Character> source) {
  if (!source) return Status::failure(StatusCode::empty_input, kNone, "no character");
  if (Status status = validate_character(*source); !status) return status;
  std::size_t triangles = 0;
  for (const Mesh& mesh : source->meshes) triangles += mesh.triangles.size();
  if (triangles > kMaximumTriangles)
    return Status::failure(StatusCode::limit_exceeded, kNone, "%zu triangles; at most %zu can be torn", triangles,
                           kMaximumTriangles);
  return TornModel(std::make_unique<State>(std::move(source)));
}

TornModel::TornModel(std::unique_ptr<State> state) : state_(std::move(state)) {}
TornModel::TornModel(TornModel&&) noexcept = default;
TornModel& TornModel::operator=(TornModel&&) noexcept = default;
TornModel::~TornModel() = default;

Result<TearReport> TornModel::tear(const ModelPose& pose, std::span<const Blade> stroke, const TearOptions& options,
                                   ChangeRecord* change) {
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (stroke.size() < 2)
    return Status::failure(StatusCode::invalid_argument, kNone, "a stroke needs at least two blades, this one has %zu",
                           stroke.size());
  if (Status status = validate_options(options); !status) return status;
  for (std::uint32_t i = 0; i < stroke.size(); ++i) {
    if (Status status = validate_blade(stroke[i], i); !status) return status;
    if (i == 0) continue;
    if (Status status = validate_turn(stroke[i - 1], stroke[i], i); !status) return status;
  }
  if (Status status = state.stand_in(pose); !status) return status;
  const tear::SurfaceEditor::Mark begin = state.begin_operation(options.wall_depth > 0);
  auto report = state.call(
      [&](State::Call& call) -> Status {
        tear::StrokeTearing tearing(stroke.front(), options);
        for (const Blade& blade : stroke.subspan(1)) tearing.extend(blade, state.workpiece());
        tearing.finish(state.workpiece());
        call.report = tearing.report;
        call.change.lips = tearing.lips;
        return {};
      },
      change);
  if (report) state.record(TearOperation{pose, {stroke.begin(), stroke.end()}, {}, options}, begin);
  return report;
}

Result<TearReport> TornModel::cut(const ModelPose& pose, const Cut& cut, ChangeRecord* change) {
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = tear::validate_cut(cut); !status) return status;
  if (Status status = state.stand_in(pose); !status) return status;
  const tear::SurfaceEditor::Mark begin = state.begin_operation(false);
  auto report = state.call(
      [&](State::Call& call) -> Status {
        tear::cut_surface(cut, state.workpiece(), call.report, call.change.lips);
        return {};
      },
      change, true);
  if (report) state.record(CutOperation{pose, cut}, begin);
  return report;
}

Result<TearReport> TornModel::drill(const ModelPose& pose, const Bore& bore, ChangeRecord* change) {
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = tear::validate_bore(bore); !status) return status;
  if (Status status = state.stand_in(pose); !status) return status;
  const tear::SurfaceEditor::Mark begin = state.begin_operation(bore.wall);
  auto report = state.call(
      [&](State::Call& call) -> Status {
        tear::drill_surface(bore, state.workpiece(), call.report);
        return {};
      },
      change);
  if (report) state.record(DrillOperation{pose, bore}, begin);
  return report;
}

Status TornModel::undo(ChangeRecord* change) {
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (state.done.empty()) return Status::failure(StatusCode::not_found, kNone, "there is nothing to undo");
  State::Done& last = state.done.back();
  ChangeRecord done;
  try {
    state.undone.reserve(state.undone.size() + 1);
    auto redo = state.editor.undo(last.begin, done);
    state.undone.push_back({std::move(last.operation), std::move(redo)});
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  state.done.pop_back();
  if (change != nullptr) *change = std::move(done);
  return {};
}

Status TornModel::redo(ChangeRecord* change) {
  State& state = *state_;
  if (Status status = state.may_begin(); !status) return status;
  if (state.undone.empty()) return Status::failure(StatusCode::not_found, kNone, "there is nothing to do again");
  State::Undone& last = state.undone.back();
  ChangeRecord done;
  try {
    state.done.reserve(state.done.size() + 1);
    const tear::SurfaceEditor::Mark begin = state.editor.mark();
    state.editor.redo(last.redo, done);
    state.done.push_back({std::move(last.operation), begin});
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  state.undone.pop_back();
  if (change != nullptr) *change = std::move(done);
  return {};
}

std::uint32_t TornModel::undo_count() const { return static_cast<std::uint32_t>(state_->done.size()); }
std::uint32_t TornModel::redo_count() const { return static_cast<std::uint32_t>(state_->undone.size()); }

std::vector<Operation> TornModel::history() const {
  std::vector<Operation> operations;
  for (const State::Done& done : state_->done) operations.push_back(done.operation);
  return operations;
}

Result<CompactMaps> TornModel::compact() {
  if (Status status = state_->may_begin(); !status) return status;
  try {
    auto source = std::make_shared<Character>(state_->character);
    CompactMaps maps = sunder::compact(*source);
    state_ = std::make_unique<State>(std::move(source));
    return maps;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

const Character& TornModel::character() const { return state_->character; }
const Character& TornModel::source() const { return *state_->source; }
std::uint32_t TornModel::point_count() const { return state_->editor.surface().point_count(); }

std::uint32_t TornModel::point_at(std::uint32_t mesh, std::uint32_t triangle, std::uint32_t corner) const {
  return state_->editor.surface().corner_point[3 * state_->editor.surface_triangle(mesh, triangle) + corner];
}

Birth TornModel::birth(std::uint32_t mesh, std::uint32_t vertex) const { return state_->editor.birth(mesh, vertex); }

std::uint32_t TornModel::source_triangle(std::uint32_t mesh, std::uint32_t triangle) const {
  return state_->editor.surface().triangle(state_->editor.surface_triangle(mesh, triangle)).source_triangle;
}

std::span<const Triangle> TornModel::fillings(std::uint32_t mesh) const { return state_->editor.fillings(mesh); }

}  // namespace sunder
