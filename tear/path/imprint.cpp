#include "tear/path/imprint.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/path/edge_crossing.h"
#include "tear/path/imprint_point.h"
#include "tear/path/leap.h"
#include "tear/surface/line_splitter.h"

namespace sunder::tear {
namespace {

/// Whether a way along an edge ends so near to the edge's end, a point of a border, that only a
/// sliver would connect them.
bool stops_short_of_border(const Step& step, const Reach& reach, const SurfaceEditor& editor,
                           PosedPoints& posed) {
  const Index corner = step.end_corner();
  if (corner == kNone || !editor.surface().is_on_border(editor.surface().corner_point[corner]))
    return false;
  const Index edge = step.fraction == 0 ? step.corner : corner;
  return reach.fraction > 1 - snapped_part(edge, Snapping::by_shape, editor, posed);
}

/// Whether a point is the end of a tear: both lips begin there, and neither parts from the other.
bool is_tip(Index point, const SurfaceEditor& editor, PosedPoints& posed) {
  const Surface& surface = editor.surface();
  const Index out = surface.first_of_fan(surface.point_corner[point]);
  if (surface.twin[out] != kNone) return false;
  Index last = out;
  for (Index c = surface.rotate_ccw(out); c != kNone; c = surface.rotate_ccw(c)) last = c;
  return posed.position(editor, surface.corner_point[Surface::next(out)]) ==
         posed.position(editor, surface.corner_point[Surface::previous(last)]);
}

/// A path that grows.
class GrowingPath {
 public:
  GrowingPath(const BladePlane& plane, Index start, SurfaceEditor& editor, PosedPoints& posed)
      : path(editor.scratch()),
        plane_(plane),
        editor_(editor),
        posed_(posed),
        here_(posed.position(editor, start)) {
    constexpr std::size_t kMany = 128;
    path.points.reserve(kMany);
    path.half_edges.reserve(kMany);
    path.points.push_back(start);
    path.progress = plane.progress(here_);
  }

  [[nodiscard]] bool has_ended() const { return has_ended_; }

  /// Goes one step on, or a leap across faces of one source triangle, or ends.
  void advance() {
    const Step step = find_step(plane_, path.points.back(), Snapping::by_shape, editor_, posed_);
    if (step.corner == kNone || !may_take(step)) return end(PathEnd::surface);
    const Reach reach = reach_between(plane_, here_, step.position);
    // The progress at which the curve ends; the path may snap to a point before it.
    come_to(plane_.progress(Vec3d(here_ + reach.fraction * (step.position - here_))));
    if (reach.fraction == 1) come_to(step.crossing_progress);
    path.crossing_progress = step.crossing_progress;
    if (reach.fraction < kSnapEdges) return end(reach.end());
    const bool crosses_face = step.end_corner() == kNone;
    if (crosses_face) ++path.faces_crossed;
    if (crosses_face && reach.is_whole() && leap(step)) return;
    if (reach.fraction < 1 - kSnapEdges && !stops_short_of_border(step, reach, editor_, posed_)) {
      stop_within(step, reach.fraction);
      return end(reach.end());
    }
    if (!take(step, reach.is_whole())) return end(PathEnd::blocked);
    if (!reach.is_whole()) end(reach.end());
  }

  Path path;

 private:
  void end(PathEnd how) {
    path.end = how;
    has_ended_ = true;
  }
  /// Whether a step belongs to the path: it leads along a lip as the first one did, or not, and to
  /// a wall only if the path began on one.
  [[nodiscard]] bool may_take(const Step& step) {
    const bool is_along_lip = leads_along_lip(step);
    const bool is_wall = !is_along_lip && editor_.is_wall(step.corner / 3);
    if (path.points.size() == 1) {
      path.is_along_lip = is_along_lip;
      path.is_on_wall = is_wall;
    }
    return is_along_lip == path.is_along_lip && (path.is_on_wall || !is_wall);
  }
  [[nodiscard]] bool leads_along_lip(const Step& step) const {
    if (step.end_corner() == kNone) return false;
    return is_lip(step.fraction == 0 ? step.corner : Surface::previous(step.corner), editor_);
  }
  void come_to(double progress) { path.progress = std::max(path.progress, progress); }
  void go_to(Index point, Index half_edge) {
    const Vec3d there = posed_.position(editor_, point);
    path.length_posed += norm(there - here_);
    path.points.push_back(point);
    path.half_edges.push_back(half_edge);
    here_ = there;
  }

  /// Flips the edges in the way that earlier tears left within the source triangle.
  bool leap(const Step& step) {
    const Leap leap = find_leap(plane_, step, editor_, posed_);
    const Index landing = take_leap(plane_, path.points.back(), leap, editor_, posed_);
    if (landing == kNone) return false;
    path.faces_crossed += leap.edges;
    come_to(leap.progress);
    go_to(landing, kNone);
    if (leap.end) end(*leap.end);
    return true;
  }

  /// Moves by `fraction` of the way to the place of a step, within the face, unless that snaps to a
  /// place behind. It snaps to a lip nearby, but not back to the tip that it extends.
  void stop_within(const Step& step, double fraction) {
    SurfaceHit hit;
    hit.triangle = step.corner / 3;
    hit.barycentric[step.corner % 3] = 1 - fraction;
    hit.barycentric[Surface::next(step.corner) % 3] = fraction * (1 - step.fraction);
    hit.barycentric[Surface::previous(step.corner) % 3] = fraction * step.fraction;
    hit.position = here_ + fraction * (step.position - here_);
    const EditLog::Mark before = editor_.mark();
    const Snapping snapping =
        is_tip(path.points.back(), editor_, posed_) ? Snapping::near : Snapping::near_or_lip;
    const Index stop = imprint_point(hit, snapping, editor_, posed_);
    if (plane_.progress(posed_.position(editor_, stop)) > plane_.progress(here_)) {
      go_to(stop, kNone);
      return;
    }
    editor_.roll_back(before);
    posed_.forget_from(before.points);
  }

  /// Goes to the place of a step and splits the far edge; if that edge cannot be split, goes to its
  /// nearer end.
  /// @param goes_on  the path does not end there: it crosses the untouched source faces beyond too.
  /// @return whether it went anywhere.
  bool take(const Step& step, bool goes_on) {
    const Surface& surface = editor_.surface();
    const auto& points = surface.corner_point;
    if (const Index corner = step.end_corner(); corner != kNone) {
      go_to(points[corner], step.fraction == 0 ? step.corner : surface.twin[corner]);
      return true;
    }
    const Index far_edge = Surface::next(step.corner);
    const Index nearer_end = points[step.fraction < 0.5 ? far_edge : Surface::next(far_edge)];
    LineSplitter splitter(editor_);
    if (const Index made = splitter.begin(far_edge, step.fraction); made != kNone) {
      posed_.pin(made, step.position);
      go_to(made, splitter.half_edge());
      for (double progress = plane_.progress(here_); goes_on && cross_next(progress, splitter);)
        ++path.faces_crossed;
      splitter.end();
      return true;
    }
    if (!(plane_.progress(posed_.position(editor_, nearer_end)) > plane_.progress(here_)))
      return false;
    go_to(nearer_end, kNone);
    return true;
  }

  /// Crosses the face ahead if it needs no closer look.
  /// @param progress_here  progress of the current place; updated.
  bool cross_next(double& progress_here, LineSplitter& splitter) {
    const Index entry = splitter.ahead();
    if (entry == kNone || !editor_.origins.is_whole(entry / 3) ||
        (!path.is_on_wall && editor_.is_wall(entry / 3)))
      return false;
    const EdgeCrossing exit = find_exit(plane_, entry, editor_, posed_);
    if (!(exit.fraction > kSnapEdges && exit.fraction < 1 - kSnapEdges)) return false;
    const Index after = editor_.surface().twin[exit.half_edge];
    if (after != kNone) editor_.fetch(after / 3);
    const Reach reach = reach_between(plane_, here_, exit.position);
    if (reach.fraction < 1 || reach.ends_at_blade) return false;
    const double progress = progress_towards(plane_, here_, exit.position, reach);
    if (!(progress > progress_here + kLeastAdvanceSweeps)) return false;
    const Index made = splitter.go_on(exit.half_edge, exit.fraction);
    if (made == kNone) return false;
    if (after != kNone)
      posed_.fetch(editor_, editor_.surface().corner_point[Surface::previous(after)]);
    posed_.pin(made, exit.position);
    come_to(progress);
    path.crossing_progress = progress;
    progress_here = progress;
    go_to(made, splitter.half_edge());
    return true;
  }

  const BladePlane& plane_;
  SurfaceEditor& editor_;
  PosedPoints& posed_;
  Vec3d here_;
  bool has_ended_ = false;
};

}  // namespace

Path imprint_path(const BladePlane& plane, Index start, SurfaceEditor& editor, PosedPoints& posed) {
  GrowingPath growing(plane, start, editor, posed);
  while (!growing.has_ended()) growing.advance();
  return std::move(growing.path);
}

}  // namespace sunder::tear
