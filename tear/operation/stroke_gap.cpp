// The gap of a stroke with a width: one convex cell per segment, mitred where two cells meet.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/operation/stroke_tearing.h"
#include "tear/path/entry.h"
#include "tear/path/imprint_point.h"
#include "tear/path/trace.h"
#include "tear/sheet/gap.h"
#include "tear/surface/improve.h"

namespace sunder::tear {
namespace {

/// The y coordinate, in the plane, of the middle of a gap at x.
double depth_at(const std::vector<Vec2d>& section, double x) {
  const auto after = std::lower_bound(section.begin(), section.end(), x,
                                      [](const Vec2d& at, double value) { return at.x() < value; });
  if (after == section.begin()) return section.front().y();
  if (after == section.end()) return section.back().y();
  const Vec2d &a = *(after - 1), &b = *after;
  return b.x() > a.x() ? a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y()) : a.y();
}

}  // namespace

StrokeTearing::PendingGap StrokeTearing::find_gap(const BladePlane& plane, const Workpiece& work) {
  PendingGap gap{plane, plane.standing_on(plane.from_progress(0)), {}, {}, {}, 0};
  const auto add = [&](Index start) {
    const bool continues = start == tip_;
    tip_ = kNone;
    const Trace trace = trace_path(plane, start, work.editor, work.posed);
    if (trace.faces.empty()) return trace.progress;
    if (!continues) ++report.runs;
    gap.seeds.push_back(start);
    gap.faces.insert(gap.faces.end(), trace.faces.begin(), trace.faces.end());
    gap.section.insert(gap.section.end(), trace.section.begin(), trace.section.end());
    gap.length += trace.length_posed;
    if (trace.end != PathEnd::blade) return trace.progress;
    tip_ = imprint_point(trace.end_place, Snapping::tight, work.editor, work.posed);
    return 1.0;
  };
  double progress = 0;
  if (tip_ != kNone) progress = std::max(0.0, add(tip_));
  for (int futile = 0; progress < 1 && futile < 64;) {
    const auto contact = find_contact(plane, progress, work);
    if (!contact) break;
    const EditLog::Mark before = work.editor.mark();
    const std::size_t seeds = gap.seeds.size();
    const double reached = add(imprint_point(*contact, Snapping::tight, work.editor, work.posed));
    const bool has_advanced = gap.seeds.size() > seeds && reached > progress + kSamePlace;
    progress = std::max(progress, reached);
    if (has_advanced) continue;
    if (gap.seeds.size() == seeds) {
      work.editor.roll_back(before);
      work.posed.forget_from(before.points);
    }
    progress = std::max(progress, contact->progress_beyond);
    ++futile;
  }
  std::stable_sort(gap.section.begin(), gap.section.end(),
                   [](const Vec2d& a, const Vec2d& b) { return a.x() < b.x(); });
  return gap;
}

void StrokeTearing::remove(const Cell& cell, std::span<const Side> sides, const PendingGap& gap,
                           const Workpiece& work) {
  SurfaceEditor& editor = work.editor;
  PosedPoints& posed = work.posed;
  std::vector<Index> faces;
  if (options_.layers == Layers::all) {
    faces = faces_in_cell(cell, editor, posed);
  } else {
    const Surface& surface = editor.surface();
    std::vector<Index> seeds;
    for (const Index point : gap.seeds)
      if (surface.point_corner[point] != kNone)
        surface.for_each_in_fan(surface.point_corner[point],
                                [&](Index corner) { seeds.push_back(corner / 3); });
    for (const Index face : gap.faces)
      if (!surface.has_repeated_point(face)) seeds.push_back(face);
    std::sort(seeds.begin(), seeds.end());
    // The blade is as wide as the gap, and it removes wrinkles of the surface. A face far below the
    // tear that faces away from the blade belongs to another layer, which the nearest one hides.
    // Faces that the tear itself crosses are never another layer.
    const auto is_same_layer = [&](Index face) {
      if (std::binary_search(seeds.begin(), seeds.end(), face)) return true;
      std::array<Vec3d, 3> corners;
      for (Index k = 0; k < 3; ++k)
        corners[k] = posed.position(editor, surface.corner_point[3 * face + k]);
      if (dot((corners[1] - corners[0]).cross(corners[2] - corners[0]), gap.plane.along()) <= 0)
        return true;
      const Vec2d middle = gap.plane.project((corners[0] + corners[1] + corners[2]) / 3);
      return middle.y() - depth_at(gap.section, middle.x()) < 2 * options_.width;
    };
    faces = faces_in_cell(cell, seeds, is_same_layer, editor, posed);
  }
  CellRim rim;
  const GapRemoval removal = remove_cell(cell, faces, editor, posed, &rim);
  add_rim_points(rim, sides, gap.plane);
  report.faces_crossed += removal.faces_crossed;
  report.blocked += removal.blocked;
  report.area_removed_posed += removal.area_posed;
  if (options_.layers == Layers::all && removal.faces_removed > 0 && !has_removed_) ++report.runs;
  has_removed_ |= removal.faces_removed > 0;
}

/// Left and right of a gap through all layers are the sides of the plane. Those of a gap in the
/// nearest layer are as seen from outside: for a layer that the blade meets from inside they are
/// exchanged.
void StrokeTearing::add_rim_points(const CellRim& rim, std::span<const Side> sides,
                                   const BladePlane& plane) {
  for (const CellRim::Edge& edge : rim.edges) {
    const Side side = edge.side == kNone ? Side::none : sides[edge.side];
    if (side == Side::none) continue;
    const bool is_seen_from_inside =
        options_.layers == Layers::nearest && dot(rim.areas[edge.part], plane.along()) > 0;
    for (const Index point : edge.points)
      borders.rim_points.push_back({point, (side == Side::left) != is_seen_from_inside});
  }
}

void StrokeTearing::remove_pending(const HalfSpace& end, const Workpiece& work) {
  const BladePlane& plane = pending_->plane;
  const double half = 0.5 * options_.width;
  // The first half-space lies left of the gap's right side, the second right of its left side.
  constexpr std::array kSides = {Side::right, Side::left, Side::none,
                                 Side::none,  Side::none, Side::none};
  remove({plane.left_of(-half), plane.right_of(half), plane.standing_on(plane.reach()[0]),
          plane.standing_on(plane.reach()[1]), pending_->start, end},
         kSides, *pending_, work);
}

/// Ends the pending gap where the next one begins. Where the stroke turns gently they share a mitre
/// plane. Where it turns sharply, or the mitre is longer than half of the shorter segment, both end
/// square and a wedge closes the outer side: mitred up to a right angle, bevelled beyond.
void StrokeTearing::join_gaps(PendingGap& next, const Vec3d& at, const Workpiece& work) {
  const Vec3d before = pending_->plane.across(), after = next.start.normal;
  const double cosine = dot(before, after), half = 0.5 * options_.width;
  const double overlap =
      cosine > -1 ? half * std::sqrt(std::max(0.0, (1 - cosine) / (1 + cosine))) : 0;
  const Vec3d normal_before = pending_->plane.normal(), normal_after = next.plane.normal();
  const auto from = [&](const Vec3d& direction, double distance) {
    return HalfSpace{direction, dot(direction, at) + distance};
  };
  if (cosine >= 0 && overlap <= 0.5 * std::min(pending_->length, next.length)) {
    const Vec3d mitre = (before + after) / norm(before + after);
    remove_pending(from(-mitre, 0), work);
    next.start = from(mitre, 0);
    return;
  }
  remove_pending(from(-before, 0), work);
  next.start = from(after, 0);
  const double outer = dot(normal_before, after) > 0 ? -1.0 : 1.0;
  Cell wedge = {from(before, 0), from(-after, 0), next.plane.standing_on(next.plane.reach()[0]),
                next.plane.standing_on(next.plane.reach()[1])};
  std::vector<Side> sides(wedge.size(), Side::none);
  if (cosine >= 0) {
    wedge.push_back(from(-outer * normal_before, -half));
    wedge.push_back(from(-outer * normal_after, -half));
  } else {
    const Vec3d bevel = outer * (normal_before + normal_after);
    if (!(norm(bevel) > 1e-6)) return;  // straight back
    wedge.push_back(
        from(-bevel / norm(bevel), -half * outer * dot(normal_before, bevel) / norm(bevel)));
  }
  sides.resize(wedge.size(), outer > 0 ? Side::left : Side::right);
  remove(wedge, sides, next, work);
}

void StrokeTearing::sweep_gap(const BladePlane& plane, const Workpiece& work) {
  const bool takes_all = options_.layers == Layers::all;
  const Index begins_at = tip_;
  const Blade from = blade_before_;
  PendingGap next{
      plane, plane.standing_on(plane.from_progress(0)), {}, {}, {}, norm(blade_.tip - from.tip)};
  if (!takes_all) next = find_gap(plane, work);
  const bool continues =
      takes_all ? pending_.has_value()
                : begins_at != kNone && !next.seeds.empty() && next.seeds.front() == begins_at;
  if (!takes_all && next.seeds.empty()) {
    ++report.segments_missed;
    return;
  }
  if (!takes_all) report.length_posed += next.length;
  if (pending_ && continues) {
    join_gaps(next,
              takes_all ? Vec3d(0.5 * (from.base + from.tip))
                        : Vec3d(work.posed.position(work.editor, begins_at)),
              work);
  } else if (pending_) {
    catch_up(work);
  } else if (continues && is_in_new_pose_) {
    next.start = start_from_rim(plane, begins_at, work);
  }
  is_in_new_pose_ = false;
  pending_ = std::move(next);
}

/// The start of a gap that continues one that was closed square in another pose: the edge that the
/// earlier gap left on both sides of the tip, as it stands in this pose, moved back a little so
/// that nothing remains between the two gaps.
HalfSpace StrokeTearing::start_from_rim(const BladePlane& plane, Index tip,
                                        const Workpiece& work) const {
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
  // A rim that does not lie across the direction of the stroke is not used.
  forward = length > 0 && dot(forward, plane.across()) > 0.5 * length ? Vec3d(forward / length)
                                                                      : plane.across();
  return {forward, dot(forward, at) - 0.1 * options_.width};
}

void StrokeTearing::catch_up(const Workpiece& work) {
  if (!pending_) return;
  const EditLog::Mark before = work.editor.mark();
  remove_pending(pending_->plane.standing_on(pending_->plane.reach()[2]), work);
  pending_.reset();
  improve_faces(before, work.editor);
}

}  // namespace sunder::tear
