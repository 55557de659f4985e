#include "tear/operation/gap_band.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/operation/walls_in_gap.h"
#include "tear/path/crack_points.h"
#include "tear/path/imprint_point.h"
#include "tear/path/trace.h"
#include "tear/surface/improve.h"

namespace sunder::tear {
namespace {

/// A sweep that gets nowhere this many times in a segment gives up.
constexpr int kMostFutileTurns = 64;
/// Number of faces around the seeds of a gap for which there is room at first.
constexpr std::size_t kFacesOfSeeds = 32;

/// Depth in the plane's y at which the middle of a gap lies at x.
double depth_at(const std::vector<Vec2d>& section, double x) {
  const auto after = std::lower_bound(section.begin(), section.end(), x,
                                      [](const Vec2d& at, double value) { return at.x() < value; });
  if (after == section.begin()) return section.front().y();
  if (after == section.end()) return section.back().y();
  const Vec2d &a = *(after - 1), &b = *after;
  return b.x() > a.x() ? a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y()) : a.y();
}

/// The half-space of the places that lie farther along `direction` than `at`, by `distance`.
PlaneSide from_place(const Vec3d& at, const Vec3d& direction, double distance) {
  return {direction, dot(direction, at) + distance};
}

/// A stable sort that allocates scratch memory only. The parts of a path are sorted already.
void sort_by_x(std::vector<Vec2d>& section, ScratchMemory& memory) {
  const auto is_before = [](const Vec2d& a, const Vec2d& b) { return a.x() < b.x(); };
  if (std::is_sorted(section.begin(), section.end(), is_before)) return;
  const ScratchMemory::Frame memory_of_step(memory);
  const ScratchVector<Vec2d> unsorted(section.begin(), section.end(), &memory);
  ScratchVector<std::pair<double, std::size_t>> order(&memory);
  order.reserve(section.size());
  for (std::size_t i = 0; i < section.size(); ++i) order.emplace_back(section[i].x(), i);
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < section.size(); ++i) section[i] = unsorted[order[i].second];
}

}  // namespace

void GapBand::Pending::begin(const BladePlane& of) {
  plane = of;
  start = of.standing_on(of.from_progress(0));
  seeds.clear();
  faces.clear();
  section.clear();
  length = 0;
}

void GapBand::begin(double width, Layers layers) {
  width_ = width;
  layers_ = layers;
  pending_.plane.reset();
  has_removed_ = is_in_new_pose_ = false;
}

void GapBand::sweep(const Segment& segment, const Workpiece& work, StrokeTip& tip,
                    Outcome& outcome) {
  const auto& [plane, from, to] = segment;
  const bool takes_all = layers_ == Layers::all;
  const Index begins_at = tip.point;
  next_.begin(plane);
  bool continues = pending_.plane.has_value();
  if (takes_all) {
    next_.length = norm(to.tip - from.tip);
  } else {
    find_gap(segment, work, tip, next_, outcome);
    continues = begins_at != kNone && !next_.seeds.empty() && next_.seeds.front() == begins_at;
    if (next_.seeds.empty()) {
      ++outcome.report.segments_missed;
      return;
    }
    outcome.report.length_posed += next_.length;
  }
  if (pending_.plane && continues) {
    const Vec3d at = takes_all ? Vec3d(0.5 * (from.base + from.tip))
                               : Vec3d(work.posed.position(work.editor, begins_at));
    join(at, work, next_, outcome);
  } else if (pending_.plane) {
    catch_up(work, outcome);
  } else if (continues && is_in_new_pose_) {
    next_.start = start_from_rim(plane, begins_at, work);
  }
  is_in_new_pose_ = false;
  std::swap(pending_, next_);
}

void GapBand::catch_up(const Workpiece& work, Outcome& outcome) {
  if (!pending_.plane) return;
  const EditLog::Mark before = work.editor.mark();
  remove_pending(pending_.plane->standing_on(pending_.plane->reach()[2]), work, outcome);
  pending_.plane.reset();
  outcome.report.blocked += match_crack_points(before, work);
  improve_faces(before, work.editor);
}

/// Follows the nearest layer along a segment. Changes only the points where the path enters and
/// ends. Moves the tip.
void GapBand::find_gap(const Segment& segment, const Workpiece& work, StrokeTip& tip, Pending& gap,
                       Outcome& outcome) const {
  const BladePlane& plane = segment.plane;
  double progress = 0;
  if (tip.point != kNone) progress = std::max(0.0, trace_gap(tip.point, work, tip, gap, outcome));
  for (int futile = 0; progress < 1 && futile < kMostFutileTurns;) {
    const auto contact = find_contact(plane, progress, work, tip);
    if (!contact) break;
    const EditLog::Mark before = work.editor.mark();
    const std::size_t seeds = gap.seeds.size();
    const Index start = imprint_point(*contact, Snapping::tight, work.editor, work.posed);
    const double reached = trace_gap(start, work, tip, gap, outcome);
    const bool has_advanced = gap.seeds.size() > seeds && reached > progress + kSamePlaceSweeps;
    progress = std::max(progress, reached);
    if (has_advanced) continue;
    if (gap.seeds.size() == seeds) {
      work.editor.roll_back(before);
      work.posed.forget_from(before.points);
    }
    progress = std::max(progress, contact->progress_beyond);
    ++futile;
  }
  sort_by_x(gap.section, work.editor.scratch());
}

/// Adds one run of the path to a gap. @return how far along the segment it reaches, in [0, 1].
double GapBand::trace_gap(Index start, const Workpiece& work, StrokeTip& tip, Pending& gap,
                          Outcome& outcome) const {
  const bool continues = start == tip.point;
  tip.point = kNone;
  const ScratchMemory::Frame memory_of_step(work.editor.scratch());
  const Trace trace = trace_path(*gap.plane, start, work.editor, work.posed);
  if (trace.faces.empty()) return trace.progress;
  if (!continues) ++outcome.report.runs;
  gap.seeds.push_back(start);
  gap.faces.insert(gap.faces.end(), trace.faces.begin(), trace.faces.end());
  gap.section.insert(gap.section.end(), trace.section.begin(), trace.section.end());
  gap.length += trace.length_posed;
  if (trace.end != PathEnd::blade) return trace.progress;
  tip.point = imprint_point(trace.end_place, Snapping::tight, work.editor, work.posed);
  return 1.0;
}

/// Ends the pending gap where the next one begins. Where the stroke turns gently they share a mitre
/// plane; where it turns sharply, or by more than the segments are long, both end square and a
/// wedge closes the outer side.
void GapBand::join(const Vec3d& at, const Workpiece& work, Pending& next, Outcome& outcome) {
  const Vec3d before = pending_.plane->across(), after = next.start.normal;
  const double cosine = dot(before, after), half = 0.5 * width_;
  const double overlap =
      cosine > -1 ? half * std::sqrt(std::max(0.0, (1 - cosine) / (1 + cosine))) : 0;
  if (cosine >= 0 && overlap <= 0.5 * std::min(pending_.length, next.length)) {
    const Vec3d mitre = (before + after) / norm(before + after);
    remove_pending(from_place(at, -mitre, 0), work, outcome);
    next.start = from_place(at, mitre, 0);
    return;
  }
  remove_pending(from_place(at, -before, 0), work, outcome);
  next.start = from_place(at, after, 0);
  close_corner(at, work, next, outcome);
}

/// Removes the wedge on the outer side of a sharp corner: mitred up to a right angle, bevelled
/// beyond.
void GapBand::close_corner(const Vec3d& at, const Workpiece& work, const Pending& next,
                           Outcome& outcome) {
  const Vec3d before = pending_.plane->across(), after = next.start.normal;
  const Vec3d normal_before = pending_.plane->normal(), normal_after = next.plane->normal();
  const double half = 0.5 * width_;
  const double outer = dot(normal_before, after) > 0 ? -1.0 : 1.0;
  std::array<PlaneSide, 6> wedge = {from_place(at, before, 0), from_place(at, -after, 0),
                                    next.plane->standing_on(next.plane->reach()[0]),
                                    next.plane->standing_on(next.plane->reach()[1])};
  std::size_t count = 4;
  if (dot(before, after) >= 0) {
    wedge[count++] = from_place(at, -outer * normal_before, -half);
    wedge[count++] = from_place(at, -outer * normal_after, -half);
  } else {
    const Vec3d bevel = outer * (normal_before + normal_after);
    if (!(norm(bevel) > kStraightBackRadians)) return;  // straight back
    wedge[count++] = from_place(at, -bevel / norm(bevel),
                                -half * outer * dot(normal_before, bevel) / norm(bevel));
  }
  std::array<Side, 6> sides;
  sides.fill(outer > 0 ? Side::left : Side::right);
  std::fill_n(sides.begin(), 4, Side::none);
  remove(std::span(wedge).first(count), sides, next, work, outcome);
}

void GapBand::remove_pending(const PlaneSide& end, const Workpiece& work, Outcome& outcome) {
  const BladePlane& plane = *pending_.plane;
  const double half = 0.5 * width_;
  // The cell lies left of the right side, and right of the left one.
  constexpr std::array kSides = {Side::right, Side::left, Side::none,
                                 Side::none,  Side::none, Side::none};
  const std::array<PlaneSide, 6> cell = {plane.left_of(-half),
                                         plane.right_of(half),
                                         plane.standing_on(plane.reach()[0]),
                                         plane.standing_on(plane.reach()[1]),
                                         pending_.start,
                                         end};
  remove(cell, kSides, pending_, work, outcome);
}

/// The start of a gap that continues one which was closed square in another pose: the edge left on
/// both sides of the tip, in its current place, and slightly before it, so that no strip remains
/// between the two gaps.
PlaneSide GapBand::start_from_rim(const BladePlane& plane, Index tip, const Workpiece& work) const {
  const Surface& surface = work.editor.surface();
  const Index first = surface.first_of_fan(surface.point_corner[tip]);
  Index last = first;
  for (Index c = surface.rotate_ccw(first); c != kNone && c != first; c = surface.rotate_ccw(c))
    last = c;
  const Vec3d at = work.posed.position(work.editor, tip);
  const Vec3d along_rim =
      work.posed.position(work.editor, surface.corner_point[Surface::next(first)]) -
      work.posed.position(work.editor, surface.corner_point[Surface::previous(last)]);
  Vec3d forward = along_rim.cross(plane.along());
  if (dot(forward, plane.across()) < 0) forward = -forward;
  const double length = norm(forward);
  // A rim that does not lie across the way says nothing.
  forward = length > 0 && dot(forward, plane.across()) > kRimAcrossCosine * length
                ? Vec3d(forward / length)
                : plane.across();
  return {forward, dot(forward, at) - kOverlapWidths * width_};
}

/// The faces of the torn layers that a cell holds a part of.
ScratchVector<CellFace> GapBand::faces_to_remove(CellSides& sides, const Pending& gap) const {
  if (layers_ == Layers::all) return faces_in_cell(sides);
  const SurfaceEditor& editor = sides.editor();
  const Surface& surface = editor.surface();
  ScratchVector<Index> seeds(&sides.memory());
  seeds.reserve(gap.faces.size() + kFacesOfSeeds);
  IndexMap is_seed(gap.faces.size() + kFacesOfSeeds, sides.memory());
  const auto add = [&](Index face) {
    if (is_seed.insert(face, 0) == kNone) seeds.push_back(face);
  };
  for (const Index point : gap.seeds)
    if (surface.point_corner[point] != kNone)
      surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) { add(corner / 3); });
  for (const Index face : gap.faces)
    if (!surface.has_repeated_point(face)) add(face);
  // The blade is as wide as the gap, and where the surface wrinkles it takes the wrinkle away. But
  // a face that turns its back on the blade far below the tear belongs to another layer, which the
  // nearest one hides; unless the tear itself goes across it.
  const auto is_same_layer = [&](const CellFace& face) {
    const Vec3d &a = sides.position(face.places[0]), &b = sides.position(face.places[1]),
                &c = sides.position(face.places[2]);
    if (dot((b - a).cross(c - a), gap.plane->along()) <= 0 || is_seed.find(face.face) != kNone)
      return true;
    const Vec2d middle = gap.plane->project((a + b + c) / 3);
    return middle.y() - depth_at(gap.section, middle.x()) < kOtherLayerWidths * width_;
  };
  return faces_in_cell(sides, seeds, width_, is_same_layer);
}

void GapBand::remove(std::span<const PlaneSide> cell, std::span<const Side> sides,
                     const Pending& gap, const Workpiece& work, Outcome& outcome) {
  const ScratchMemory::Frame memory_of_step(work.editor.scratch());
  CellRim rim(work.editor.scratch());
  CellSides with_walls(cell, work.editor, work.posed);
  ScratchVector<CellFace> faces = faces_to_remove(with_walls, gap);
  const bool had_walls = remove_walls_in_gap(cell, faces, *gap.plane, work);
  std::optional<CellSides> without;
  if (had_walls) faces = faces_to_remove(without.emplace(cell, work.editor, work.posed), gap);
  const GapRemoval removal =
      remove_cell(had_walls ? *without : with_walls, faces, work.editor, &rim);
  add_rim_points(rim, sides, *gap.plane, outcome);
  outcome.report.faces_crossed += removal.faces_crossed;
  outcome.report.blocked += removal.blocked;
  outcome.report.area_removed_posed += removal.area_posed;
  if (layers_ == Layers::all && removal.faces_removed > 0 && !has_removed_) ++outcome.report.runs;
  has_removed_ |= removal.faces_removed > 0;
}

/// The lips of a sheet through all layers are distinguished by the side of the plane; those of a
/// path along the nearest layer as seen from outside. In a layer that the blade meets from inside,
/// left and right are exchanged.
void GapBand::add_rim_points(const CellRim& rim, std::span<const Side> sides,
                             const BladePlane& plane, Outcome& outcome) const {
  for (const CellRim::Edge& edge : rim.edges) {
    const Side side = edge.side == kNone ? Side::none : sides[edge.side];
    if (side == Side::none) continue;
    const bool is_seen_from_inside =
        layers_ == Layers::nearest && dot(rim.areas[edge.part], plane.along()) > 0;
    for (const Index point : edge.points)
      outcome.borders.rim_points.push_back({point, (side == Side::left) != is_seen_from_inside});
  }
}

}  // namespace sunder::tear
