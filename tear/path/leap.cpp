#include "tear/path/leap.h"

#include <algorithm>

#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/path/edge_crossing.h"
#include "tear/path/imprint_point.h"
#include "tear/surface/turn_edges.h"

namespace sunder::tear {

Leap find_leap(const BladePlane& plane, const Step& step, const SurfaceEditor& editor,
               PosedPoints& posed) {
  EdgeCrossing at{Surface::next(step.corner), step.fraction, step.position};
  Leap leap{at.place(), 0, step.crossing_progress, {}};
  while (editor.origins.is_inner_edge(at.half_edge)) {
    const EdgeCrossing entry = at.from_across(editor.surface());
    const EdgeCrossing exit = find_exit(plane, entry.half_edge, editor, posed);
    if (!(plane.progress(exit.position) > plane.progress(entry.position) + kLeastAdvanceSweeps))
      break;
    ++leap.edges;
    const Reach reach = reach_between(plane, entry.position, exit.position);
    leap.landing = place_between(entry.place(), exit.place(), reach.fraction);
    leap.progress = plane.progress(leap.landing.position);
    if (!reach.is_whole()) {
      leap.end = reach.end();
      break;
    }
    const double snap = snapped_part(exit.half_edge, Snapping::by_shape, editor, posed);
    if (exit.fraction < snap || exit.fraction > 1 - snap) break;
    at = exit;
  }
  return leap;
}

Index take_leap(const BladePlane& plane, Index here, const Leap& leap, SurfaceEditor& editor,
                PosedPoints& posed) {
  if (leap.edges == 0) return kNone;
  const EditLog::Mark before = editor.mark();
  const Index landing =
      imprint_point(leap.landing, leap.end ? Snapping::near : Snapping::by_shape, editor, posed);
  const bool goes_forward = landing != here && plane.progress(posed.position(editor, landing)) >
                                                   plane.progress(posed.position(editor, here));
  if (goes_forward && turn_edges_into_line(here, landing, leap.landing.triangle, editor))
    return landing;
  editor.roll_back(before);
  posed.forget_from(before.points);
  return kNone;
}

}  // namespace sunder::tear
