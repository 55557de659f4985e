#include "tear/path/trace.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/path/edge_crossing.h"

namespace sunder::tear {

Trace trace_path(const BladePlane& plane, Index start, const SurfaceEditor& editor,
                 PosedPoints& posed) {
  Trace trace(editor.scratch());
  const Surface& surface = editor.surface();
  const auto progress_at = [&](const Vec3d& at) { return plane.progress(at); };
  Vec3d here = posed.position(editor, start);
  trace.progress = progress_at(here);
  trace.section.push_back(plane.project(here));

  const Step first = find_step(plane, start, Snapping::tight, editor, posed);
  if (first.corner == kNone) return trace;
  const bool is_on_wall = editor.is_wall(first.corner / 3);
  SurfaceHit from;  // where the curve entered the face
  from.triangle = first.corner / 3;
  from.position = here;
  from.barycentric[first.corner % 3] = 1;
  EdgeCrossing exit = cross_edge(plane, Surface::next(first.corner), editor, posed);
  // A curve that goes forward passes a face once.
  for (Index guard = 0; guard <= surface.triangle_count(); ++guard) {
    trace.faces.push_back(exit.half_edge / 3);
    const Reach reach = reach_between(plane, here, exit.position);
    const Vec3d reached = here + reach.fraction * (exit.position - here);
    trace.length_posed += norm(reached - here);
    trace.progress = std::max(trace.progress, progress_at(reached));
    trace.section.push_back(plane.project(reached));
    if (!reach.is_whole()) {
      trace.end = reach.end();
      trace.end_place = place_between(from, exit.place(), reach.fraction);
      return trace;
    }
    const Index across = surface.twin[exit.half_edge];
    if (across == kNone || (!is_on_wall && editor.is_wall(across / 3))) return trace;
    here = exit.position;
    const EdgeCrossing entry = exit.from_across(surface);
    from = entry.place();
    exit = find_exit(plane, entry.half_edge, editor, posed);
    if (!(progress_towards(plane, here, exit.position) - progress_at(here) > -kLeastAdvanceSweeps))
      return trace;  // the surface folds away from the blade
  }
  return trace;
}

}  // namespace sunder::tear
