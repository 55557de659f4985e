#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <new>

#include "tear/entry.h"
#include "tear/imprint.h"
#include "tear/open.h"

namespace sunder {
namespace {

using tear::BladePlane;
using tear::Index;
using tear::Path;
using tear::PosedPoints;
using tear::SurfaceEditor;

/// Corners have 32-bit numbers; this leaves half of them to what tears append.
constexpr std::size_t kMaximumTriangles = kNone / 6;

Status validate_stroke(std::span<const Blade> stroke) {
  if (stroke.size() < 2)
    return Status::failure(StatusCode::invalid_argument, kNone, "a stroke needs at least two blades, this one has %zu",
                           stroke.size());
  for (Index i = 0; i < stroke.size(); ++i) {
    const Blade& blade = stroke[i];
    if (!blade.base.allFinite() || !blade.tip.allFinite())
      return Status::failure(StatusCode::non_finite_value, i, "blade %u is not finite", i);
    // Products of four coordinates must stay finite.
    if (blade.base.cwiseAbs().maxCoeff() > 1e60 || blade.tip.cwiseAbs().maxCoeff() > 1e60)
      return Status::failure(StatusCode::invalid_argument, i, "blade %u lies beyond 1e60", i);
    if (!((blade.tip - blade.base).norm() > 1e-30))
      return Status::failure(StatusCode::invalid_argument, i, "blade %u has no length", i);
    if (i > 0 && !((blade.tip - blade.base).normalized().dot((stroke[i - 1].tip - stroke[i - 1].base).normalized()) > 0))
      return Status::failure(StatusCode::invalid_argument, i,
                             "blade %u is turned by 90 degrees or more against the one before it: sample the stroke more finely",
                             i);
  }
  return {};
}

}  // namespace

struct TornModel::State {
  explicit State(std::shared_ptr<const Character> from) : source(std::move(from)), character(*source), editor(*source, character) {
    for (const Index side : editor.surface().point_side) next_side = std::max(next_side, side + 1);
  }

  void tear_segment(const Blade& from, const Blade& to);
  /// Tears on from `start`. @return the progress up to which the segment is done.
  double tear_piece(const BladePlane& plane, Index start, const SurfaceEditor::Mark& before);

  std::shared_ptr<const Character> source;
  Character character;
  SurfaceEditor editor;
  PosedPoints posed;
  Index next_side = 1;

  // Of the operation under way.
  Index tip = kNone;       ///< Where the tear stands, while it stands on the surface.
  Index last_end = kNone;  ///< Where the last piece of the segment under way ended.
  TearReport report;
  std::size_t torn_edges = 0;
  std::vector<LipPair> lips;
};

double TornModel::State::tear_piece(const BladePlane& plane, Index start, const SurfaceEditor::Mark& before) {
  Path path = tear::imprint_path(plane, start, editor, posed);
  const bool continues = start == tip;
  tip = kNone;
  if (path.end == Path::End::blocked) ++report.blocked;

  // A tear of one edge between two tips would be closed at both ends of its only edge: it needs a point that can open.
  const auto is_on_border = [&](Index point) {
    const auto& surface = editor.surface();
    return surface.rotate_cw(surface.first_of_fan(surface.point_corner[point])) == kNone;
  };
  if (path.points.size() == 2 && !is_on_border(path.points[0]) && !is_on_border(path.points[1])) {
    const Index middle = tear::imprint_midpoint(editor.surface().find_half_edge(path.points[0], path.points[1]), editor, posed);
    if (middle == kNone)
      path.points.pop_back();
    else
      path.points.insert(path.points.begin() + 1, middle);
  }
  // Where the last piece of this segment snapped, something of the section may be left beside it: not a piece of its own.
  const bool is_leftover = path.points.back() == last_end;
  if (path.points.size() < 2 || is_leftover) {
    editor.roll_back(before);
    posed.forget_from(before.points);
    if (path.end == Path::End::blade && start < before.points) tip = start;  // moved by less than can be told: go on from here
    return path.end == Path::End::blade ? 1.0 : path.progress;
  }
  const std::size_t first_lip = lips.size();
  tear::open_path(path.points, editor, next_side, lips);
  for (std::size_t i = first_lip; i < lips.size(); ++i) posed.pin(lips[i].left, Vec3d(posed.position(editor, lips[i].right)));
  torn_edges += path.points.size() - 1;
  if (!continues) ++report.runs;
  report.faces_crossed += path.faces_crossed;
  report.length_posed += path.length_posed;
  last_end = path.points.back();
  if (path.end != Path::End::blade) return path.progress;
  tip = last_end;
  return 1.0;
}

void TornModel::State::tear_segment(const Blade& from, const Blade& to) {
  const std::size_t edges_before = torn_edges;
  last_end = kNone;
  Vec3d anchor = 0.5 * (from.base + from.tip);
  if (tip != kNone)
    anchor = posed.position(editor, tip);
  else if (const auto hit = tear::first_hit(from, editor, posed))
    anchor = hit->position;
  const auto plane = BladePlane::through(anchor, from, to);
  if (!plane) return;  // the blade stands still; so does the tip

  double progress = 0;
  if (tip != kNone) progress = std::max(0.0, tear_piece(*plane, tip, editor.mark()));

  // Where the surface ends, folds away or cannot be split, the sweep goes on to whatever it meets next. Every turn passes a
  // triangle at least; a sweep that gets nowhere in many turns gives up.
  for (int futile = 0; progress < 1 && futile < 64;) {
    const auto contact = tear::first_contact(*plane, progress, editor, posed);
    if (!contact) break;
    const SurfaceEditor::Mark before = editor.mark();
    const std::size_t edges = torn_edges;
    const double reached = tear_piece(*plane, tear::imprint_point(*contact, editor, posed), before);
    const bool has_advanced = torn_edges > edges && reached > progress + tear::kSamePlace;
    progress = std::max(progress, reached);
    if (has_advanced) continue;
    progress = std::max(progress, contact->progress_beyond);
    ++futile;
  }
  if (torn_edges == edges_before && tip == kNone) ++report.segments_missed;
}

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

Result<TearReport> TornModel::tear(const ModelPose& pose, std::span<const Blade> stroke, const TearOptions&, ChangeRecord* change) {
  State& state = *state_;
  if (Status status = validate_stroke(stroke); !status) return status;
  if (Status status = state.posed.begin(state.character, pose); !status) return status;

  state.report = {};
  state.torn_edges = 0;
  state.report.segments = static_cast<Index>(stroke.size() - 1);
  state.lips.clear();
  state.tip = kNone;
  const SurfaceEditor::Mark begin = state.editor.mark();
  ChangeRecord done;
  try {
    for (std::size_t i = 0; i + 1 < stroke.size(); ++i) state.tear_segment(stroke[i], stroke[i + 1]);
    state.editor.commit(begin, done);
  } catch (const std::bad_alloc&) {
    state.editor.roll_back(begin);
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  done.lips = state.lips;
  state.report.points_added = done.point_count;
  for (const MeshChange& mesh : done.meshes) {
    state.report.vertices_added += mesh.vertex_count;
    state.report.triangles_added += mesh.triangle_count;
  }
  if (change != nullptr) *change = std::move(done);
  return state.report;
}

const Character& TornModel::character() const { return state_->character; }
const Character& TornModel::source() const { return *state_->source; }
std::uint32_t TornModel::point_count() const { return state_->editor.surface().point_count(); }

std::uint32_t TornModel::point_at(std::uint32_t mesh, std::uint32_t triangle, std::uint32_t corner) const {
  return state_->editor.surface().corner_point[3 * state_->editor.surface_triangle(mesh, triangle) + corner];
}

Birth TornModel::birth(std::uint32_t mesh, std::uint32_t vertex) const { return state_->editor.birth(mesh, vertex); }

std::uint32_t TornModel::source_triangle(std::uint32_t mesh, std::uint32_t triangle) const {
  return state_->editor.surface().triangles[state_->editor.surface_triangle(mesh, triangle)].source_triangle;
}

}  // namespace sunder
