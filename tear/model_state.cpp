#include "tear/model_state.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "tear/pieces.h"

namespace sunder {

TornModel::State::State(std::shared_ptr<const Character> from)
    : source(std::move(from)), character(*source), editor(*source, character) {}

Status TornModel::State::may_begin() const {
  return has_stroke ? Status::failure(StatusCode::invalid_argument, kNone, "a stroke is under way; end it first") : Status();
}

Status TornModel::State::stand_in(const ModelPose& wanted) {
  if (Status status = posed.begin(character, wanted); !status) return status;
  pose = wanted;
  return {};
}

Result<TearReport> TornModel::State::call(const std::function<Status(Call&)>& work, ChangeRecord* change, bool is_cut) {
  editor.scratch().reset();
  Call call{editor.mark(), {}, {}};
  const auto take_back = [&] {
    editor.roll_back(call.begin);
    posed.forget_from(call.begin.points);
  };
  try {
    if (Status status = work(call); !status) {
      take_back();
      return status;
    }
    editor.describe(call.begin, call.change);
    count(call.begin, is_cut, call.report);
  } catch (const std::bad_alloc&) {
    take_back();
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  if (change != nullptr) *change = std::move(call.change);
  return std::move(call.report);
}

void TornModel::State::count(const tear::SurfaceEditor::Mark& begin, bool is_cut, TearReport& report) {
  report.points_added = editor.surface().point_count() - begin.points;
  report.triangles_added = editor.surface().triangle_count() - begin.triangles;
  report.vertices_added = editor.vertices_since(begin);
  report.triangles_retired = 0;
  editor.for_each_changed(begin, [&](std::uint32_t triangle) {
    report.triangles_retired += editor.surface().corner_point[3 * triangle] == kNone ? 1 : 0;
  });
  report.pieces = tear::find_pieces(begin, is_cut, editor, posed);
}

void TornModel::State::record(Operation operation, const tear::SurfaceEditor::Mark& begin) {
  if (editor.numbers_since(begin) == 0) return;  // it did nothing
  done.push_back({std::move(operation), begin});
  undone.clear();
}

Status validate_blade(const Blade& blade, std::uint32_t index) {
  if (!blade.base.allFinite() || !blade.tip.allFinite())
    return Status::failure(StatusCode::non_finite_value, index, "blade %u is not finite", index);
  // Products of four coordinates must stay finite.
  if (blade.base.cwiseAbs().maxCoeff() > 1e60 || blade.tip.cwiseAbs().maxCoeff() > 1e60)
    return Status::failure(StatusCode::invalid_argument, index, "blade %u lies beyond 1e60", index);
  if (!((blade.tip - blade.base).norm() > 1e-30))
    return Status::failure(StatusCode::invalid_argument, index, "blade %u has no length", index);
  return {};
}

Status validate_turn(const Blade& before, const Blade& blade, std::uint32_t index) {
  if ((blade.tip - blade.base).normalized().dot((before.tip - before.base).normalized()) > 0) return {};
  return Status::failure(StatusCode::invalid_argument, index,
                         "blade %u is turned by 90 degrees or more against the one before it: sample the stroke more finely",
                         index);
}

Status validate_options(const TearOptions& options) {
  const auto is_length = [](double value) { return value >= 0 && value <= 1e30; };
  if (!is_length(options.width))
    return Status::failure(StatusCode::invalid_argument, kNone, "a gap is 0 to 1e30 wide, not %g", options.width);
  if (!is_length(options.wall_depth))
    return Status::failure(StatusCode::invalid_argument, kNone, "a wall is 0 to 1e30 deep, not %g", options.wall_depth);
  if (options.layers != Layers::nearest && options.layers != Layers::all)
    return Status::failure(StatusCode::invalid_argument, kNone, "unknown layers %u", static_cast<unsigned>(options.layers));
  return {};
}

}  // namespace sunder
