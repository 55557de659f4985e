#include "tear/trace.h"

#include <algorithm>

namespace sunder::tear {
namespace {

/// A place on a half-edge of the face that the curve is about to cross.
struct OnEdge {
  Index half_edge = kNone;
  double fraction = 0;
  Vec3d position = Vec3d::Zero();
};

OnEdge cross_edge(const BladePlane& plane, Index half_edge, const SurfaceEditor& editor, PosedPoints& posed) {
  const auto& points = editor.surface().corner_point;
  const Vec3d from = posed.position(editor, points[half_edge]);
  const Vec3d to = posed.position(editor, points[Surface::next(half_edge)]);
  const double at_from = plane.distance(from), at_to = plane.distance(to);
  const double fraction = at_from == at_to ? 0.0 : std::clamp(at_from / (at_from - at_to), 0.0, 1.0);
  return {half_edge, fraction, from + fraction * (to - from)};
}

/// Where the plane leaves a face that it entered through `half_edge`.
OnEdge find_exit(const BladePlane& plane, Index half_edge, const SurfaceEditor& editor, PosedPoints& posed) {
  const auto& points = editor.surface().corner_point;
  const auto is_left = [&](Index corner) { return plane.distance(posed.position(editor, points[corner])) >= 0; };
  const Index opposite = Surface::previous(half_edge);
  return cross_edge(plane, is_left(opposite) == is_left(half_edge) ? Surface::next(half_edge) : opposite, editor, posed);
}

SurfaceHit place_on(const OnEdge& at) {
  SurfaceHit hit;
  hit.triangle = at.half_edge / 3;
  hit.barycentric[at.half_edge % 3] = 1 - at.fraction;
  hit.barycentric[Surface::next(at.half_edge) % 3] = at.fraction;
  hit.position = at.position;
  return hit;
}

}  // namespace

Trace trace_path(const BladePlane& plane, Index start, const SurfaceEditor& editor, PosedPoints& posed) {
  Trace trace;
  const Surface& surface = editor.surface();
  const auto progress_at = [&](const Vec3d& at) { return plane.sweep_coordinates(plane.project(at)).progress; };
  Vec3d here = posed.position(editor, start);
  trace.progress = progress_at(here);
  trace.section.push_back(plane.project(here));

  const Step first = find_step(plane, start, Snapping::tight, editor, posed);
  if (first.corner == kNone) return trace;
  SurfaceHit from;  // where the curve entered the face
  from.triangle = first.corner / 3;
  from.barycentric[first.corner % 3] = 1;
  OnEdge exit = cross_edge(plane, Surface::next(first.corner), editor, posed);
  // A curve that goes forward passes a face once.
  for (Index guard = 0; guard <= surface.triangle_count(); ++guard) {
    trace.faces.push_back(exit.half_edge / 3);
    const Reach reach = reach_between(plane, here, exit.position);
    const Vec3d reached = here + reach.fraction * (exit.position - here);
    trace.length_posed += (reached - here).norm();
    trace.progress = std::max(trace.progress, progress_at(reached));
    trace.section.push_back(plane.project(reached));
    if (reach.fraction < 1 || reach.ends_at_blade) {
      trace.end = reach.ends_at_blade ? Path::End::blade : Path::End::surface;
      const SurfaceHit to = place_on(exit);
      trace.end_place = {to.triangle, {}, reached, 0};
      for (std::size_t k = 0; k < 3; ++k)
        trace.end_place.barycentric[k] = (1 - reach.fraction) * from.barycentric[k] + reach.fraction * to.barycentric[k];
      return trace;
    }
    const Index entry = surface.twin[exit.half_edge];
    if (entry == kNone) return trace;
    here = exit.position;
    from = place_on({entry, 1 - exit.fraction, here});
    exit = find_exit(plane, entry, editor, posed);
    if (!(sweep_towards(plane, here, exit.position).progress - progress_at(here) > -1e-12))
      return trace;  // the surface folds away from the blade
  }
  return trace;
}

}  // namespace sunder::tear
