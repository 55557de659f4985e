#include "tear/operation/stroke_tearing.h"

#include <algorithm>
#include <utility>

#include "tear/filling/walls.h"
#include "tear/geometry/tolerances.h"
#include "tear/path/entry.h"
#include "tear/path/imprint.h"
#include "tear/path/imprint_point.h"
#include "tear/sheet/open_sheet.h"
#include "tear/surface/improve.h"

namespace sunder::tear {

bool StrokeTearing::stands_on_surface(const Workpiece& work) const {
  return tip_ != kNone && work.editor.surface().point_corner[tip_] != kNone;
}

void StrokeTearing::begin(const Blade& first, const TearOptions& options) {
  report = {};
  borders.clear();
  options_ = options;
  blade_ = blade_before_ = first;
  stroke_.assign(1, first);
  tip_ = last_end_ = kNone;
  met_.reset();
  torn_edges_ = 0;
  pending_.reset();
  held_by_.reset();
  has_removed_ = is_in_new_pose_ = false;
}

void StrokeTearing::leave_pose(const Workpiece& work) {
  catch_up(work);
  held_by_.reset();
  if (stands_on_surface(work))
    held_before_ = work.posed.position(work.editor, tip_);
  else if (held_by_ = first_hit(blade_, work.editor, work.posed); held_by_)
    held_before_ = held_by_->position;
}

void StrokeTearing::enter_pose(const Workpiece& work) {
  is_in_new_pose_ = true;
  Vec3d moved = -held_before_;
  if (stands_on_surface(work)) {
    moved += work.posed.position(work.editor, tip_);
  } else if (held_by_) {
    for (Index k = 0; k < 3; ++k)
      moved += held_by_->barycentric[k] *
               work.posed.position(work.editor,
                                   work.editor.surface().corner_point[3 * held_by_->triangle + k]);
  } else {
    return;
  }
  blade_ = {blade_.base + moved, blade_.tip + moved};
}

void StrokeTearing::extend(const Blade& to, const Workpiece& work) {
  ++report.segments;
  if (options_.wall_depth > 0) stroke_.push_back(to);
  const Blade from = blade_before_ = blade_;
  blade_ = to;
  last_end_ = kNone;
  if (!stands_on_surface(work)) tip_ = kNone;
  Vec3d anchor = 0.5 * (from.base + from.tip);
  met_.reset();
  if (options_.layers == Layers::nearest) {
    if (tip_ != kNone)
      anchor = work.posed.position(work.editor, tip_);
    else if (met_ = first_hit(from, work.editor, work.posed); met_)
      anchor = met_->position;
  }
  const auto plane = BladePlane::through(anchor, from, to);
  if (!plane) return;  // the blade did not move, and neither does the tip

  const EditLog::Mark before = work.editor.mark();
  if (options_.width > 0)
    sweep_gap(*plane, work);
  else if (options_.layers == Layers::all)
    tear_all_layers(*plane, work);
  else
    tear_segment(*plane, work);
  improve_faces(before, work.editor);
}

void StrokeTearing::finish(const Workpiece& work) {
  catch_up(work);
  if (options_.wall_depth > 0)
    add_walls(work.editor.opened_edges.borders(), stroke_, options_.wall_depth, work);
}

double StrokeTearing::tear_piece(const BladePlane& plane, Index start, const EditLog::Mark& before,
                                 const Workpiece& work) {
  SurfaceEditor& editor = work.editor;
  PosedPoints& posed = work.posed;
  Path path = imprint_path(plane, start, editor, posed);
  const bool continues = start == tip_ && tip_ends_run_;
  tip_ = kNone;
  if (path.end == PathEnd::blocked) ++report.blocked;

  // A tear of a single edge between two tips stays closed at both ends of the edge, so it needs
  // another point that can open.
  if (path.points.size() == 2 && !editor.surface().is_on_border(path.points[0]) &&
      !editor.surface().is_on_border(path.points[1])) {
    const Index edge = editor.surface().find_half_edge(path.points[0], path.points[1]);
    const Index middle = split_posed_edge(edge, 0.5, editor, posed);
    if (middle == kNone)
      path.points.pop_back();
    else
      path.points.insert(path.points.begin() + 1, middle);
    path.half_edges.clear();
  }
  // Where the last piece of this segment snapped, a part of the section may remain next to it. That
  // part is not a piece of its own.
  const bool is_leftover = path.points.back() == last_end_;
  if (path.points.size() < 2 || is_leftover) {
    editor.roll_back(before);
    posed.forget_from(before.points);
    if (path.end == PathEnd::blade &&
        start < before.points) {  // the movement is too small to tear: the tip stays
      tip_ = start;
      tip_ends_run_ = continues;
    }
    return path.end == PathEnd::blade ? 1.0 : path.progress;
  }
  ScratchVector<PointEdge> edges(&editor.scratch());
  edges.reserve(path.points.size() - 1);
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i)
    edges.push_back({path.points[i], path.points[i + 1]});
  std::vector<LipPair>& lips = borders.lips;
  const std::size_t first_lip = lips.size();
  open_edges(edges, path.half_edges, editor, lips);
  for (std::size_t i = first_lip; i < lips.size(); ++i)
    posed.pin(lips[i].left, Vec3d(posed.position(editor, lips[i].right)));
  torn_edges_ += edges.size();
  if (!continues) ++report.runs;
  report.faces_crossed += path.faces_crossed;
  report.length_posed += path.length_posed;
  last_end_ = path.points.back();
  if (path.end != PathEnd::blade) return path.progress;
  tip_ = last_end_;
  tip_ends_run_ = true;
  return 1.0;
}

std::optional<SurfaceHit> StrokeTearing::find_contact(const BladePlane& plane, double progress,
                                                      const Workpiece& work) {
  if (const auto met = std::exchange(met_, std::nullopt); met && progress == 0)
    if (const auto contact = contact_at(*met, plane, work.editor, work.posed)) return contact;
  return first_contact(plane, progress, work.editor, work.posed);
}

void StrokeTearing::tear_segment(const BladePlane& plane, const Workpiece& work) {
  const std::size_t edges_before = torn_edges_;
  double progress = 0;
  if (tip_ != kNone) progress = std::max(0.0, tear_piece(plane, tip_, work.editor.mark(), work));

  // Where the surface ends, folds away or cannot be split, the sweep continues to the place that it
  // meets next. Each iteration passes at least one triangle. A sweep that does not advance in 64
  // iterations ends.
  for (int futile = 0; progress < 1 && futile < 64;) {
    const auto contact = find_contact(plane, progress, work);
    if (!contact) break;
    const EditLog::Mark before = work.editor.mark();
    const std::size_t edges = torn_edges_;
    const double reached = tear_piece(
        plane, imprint_point(*contact, Snapping::by_shape, work.editor, work.posed), before, work);
    const bool has_advanced = torn_edges_ > edges && reached > progress + kSamePlace;
    progress = std::max(progress, reached);
    if (has_advanced) continue;
    progress = std::max(progress, contact->progress_beyond);
    ++futile;
  }
  if (torn_edges_ == edges_before && tip_ == kNone) ++report.segments_missed;
}

void StrokeTearing::tear_all_layers(const BladePlane& plane, const Workpiece& work) {
  Sheet sheet{plane.left_of(0), {}};
  for (const auto& reach : plane.reach()) sheet.bounds.push_back({plane.standing_on(reach), kNone});
  sheet.bounds.push_back({plane.standing_on(plane.from_progress(0)), kNone});
  const SheetOpening opening = open_sheet(sheet, work, borders.lips);
  report.faces_crossed += opening.faces_crossed;
  report.blocked += opening.blocked;
  report.length_posed += opening.length_posed;
  report.runs += opening.runs;
  if (opening.edges.empty()) ++report.segments_missed;
}

}  // namespace sunder::tear
