#include "tear/path/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::tear {

Reach reach_between(const BladePlane& plane, const Vec3d& from, const Vec3d& to) {
  const Vec2d a = plane.project(from), b = plane.project(to);
  Reach reach;
  for (std::size_t i = 0; i < plane.reach().size(); ++i) {
    const double at_b = plane.reach()[i].value(b);
    if (at_b > 0) continue;  // inside
    const double at_a = plane.reach()[i].value(a);
    if (at_b >= at_a) continue;  // coming back in
    const double fraction = std::clamp(at_a / (at_a - at_b), 0.0, 1.0);
    if (fraction < reach.fraction || (fraction == reach.fraction && i == 2))
      reach = {fraction, i == 2};
  }
  return reach;
}

double progress_towards(const BladePlane& plane, const Vec3d& from, const Vec3d& to) {
  return progress_towards(plane, from, to, reach_between(plane, from, to));
}

double progress_towards(const BladePlane& plane, const Vec3d& from, const Vec3d& to,
                        const Reach& reach) {
  const double part = reach.fraction;
  const Vec2d b = plane.project(to);
  const double at_b = plane.not_before().value(b);
  if (part == 1 && at_b >= 0) return plane.progress(b);
  const Vec2d a = plane.project(from);
  const double at_a = plane.not_before().value(a);
  if (at_b < 0 && at_b < at_a && at_a / (at_a - at_b) < part)
    return -std::numeric_limits<double>::infinity();
  return plane.progress(Vec2d(a + std::max(part, kSnapEdges) * (b - a)));
}

namespace {

/// Chooses among the steps by which the plane leaves a point across the faces around it.
class StepChoice {
 public:
  StepChoice(const BladePlane& plane, const Vec3d& from, Snapping snapping,
             const SurfaceEditor& editor, PosedPoints& posed)
      : plane_(plane),
        from_(from),
        progress_here_(plane.progress(from)),
        snapping_(snapping),
        editor_(editor),
        posed_(posed) {}

  /// An end of a far edge.
  struct EdgeEnd {
    const Vec3d* position;
    double distance;  ///< Distance from the plane.
  };
  void consider(Index corner, const EdgeEnd& a, const EdgeEnd& b) {
    const Step step = step_across(corner, a, b);
    const double progress = progress_towards(plane_, from_, step.position) - progress_here_;
    if (!(progress > kLeastAdvanceSweeps)) return;
    if (best_.corner != kNone && slope(step, progress) >= slope(best_, best_progress_)) return;
    best_ = step;
    best_progress_ = progress;
  }
  [[nodiscard]] const Step& best() const { return best_; }

 private:
  [[nodiscard]] Step step_across(Index corner, const EdgeEnd& a, const EdgeEnd& b) {
    Step step;
    step.corner = corner;
    step.fraction = a.distance / (a.distance - b.distance);
    step.position = *a.position + step.fraction * (*b.position - *a.position);
    step.crossing_progress = plane_.progress(step.position);
    const bool is_at_a = step.fraction < 0.5;
    const Vec3d& nearer_end = is_at_a ? *a.position : *b.position;
    if (!snaps(step, nearer_end)) return step;
    step.fraction = is_at_a ? 0 : 1;
    step.position = nearer_end;
    return step;
  }

  [[nodiscard]] bool snaps(const Step& step, const Vec3d& nearer_end) {
    if (std::min(step.fraction, 1 - step.fraction) < kTightSnapEdges) return true;
    const double snap = snapped_part(Surface::next(step.corner), snapping_, editor_, posed_);
    if (!(step.fraction < snap || step.fraction > 1 - snap)) return false;
    // In a sliver an end may be near but lie in another direction, such as the one from which the
    // tear came.
    const Vec3d way = step.position - from_, snapped_way = nearer_end - from_;
    return dot(way, snapped_way) > 0.5 * norm(way) * norm(snapped_way);
  }

  /// Change of depth per progress.
  [[nodiscard]] double slope(const Step& step, double progress) const {
    const double part = std::max(reach_between(plane_, from_, step.position).fraction, kSnapEdges);
    const Vec3d reached = from_ + part * (step.position - from_);
    return (plane_.sweep_coordinates(plane_.project(reached)).depth -
            plane_.sweep_coordinates(plane_.project(from_)).depth) /
           progress;
  }

  const BladePlane& plane_;
  const Vec3d& from_;
  double progress_here_;
  Snapping snapping_;
  const SurfaceEditor& editor_;
  PosedPoints& posed_;
  Step best_;
  double best_progress_ = 0;
};

}  // namespace

Index Step::end_corner() const {
  if (fraction == 0) return Surface::next(corner);
  if (fraction == 1) return Surface::previous(corner);
  return kNone;
}

Step find_step(const BladePlane& plane, Index point, Snapping snapping, const SurfaceEditor& editor,
               PosedPoints& posed) {
  const Surface& surface = editor.surface();
  posed.cover(surface.point_count());
  StepChoice choice(plane, posed.position(editor, point), snapping, editor, posed);
  const auto end_at = [&](Index corner) -> StepChoice::EdgeEnd {
    const Vec3d& position = posed.position(editor, surface.corner_point[corner]);
    return {&position, plane.distance(position)};
  };
  // The far edges around the point are a chain: each of its points is looked at once.
  const Index first = surface.first_of_fan(surface.point_corner[point]);
  StepChoice::EdgeEnd a = end_at(Surface::next(first));
  for (Index corner = first; corner != kNone;) {
    const StepChoice::EdgeEnd b = end_at(Surface::previous(corner));
    if ((a.distance >= 0) != (b.distance >= 0)) choice.consider(corner, a, b);
    a = b;
    corner = surface.rotate_ccw(corner);
    if (corner == first) break;
  }
  return choice.best();
}

}  // namespace sunder::tear
