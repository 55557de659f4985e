#pragma once

#include "tear/path/snapping.h"
#include "tear/path/surface_hit.h"

namespace sunder::tear {

/// Turns a place on the surface into a point: an existing point if the place snaps to it, otherwise
/// a new one by splitting an edge or a face. If the face is too small to be split, the nearest end
/// of the nearest edge. A new point is pinned to its place in the pose.
[[nodiscard]] Index imprint_point(const SurfaceHit& hit, Snapping snapping, SurfaceEditor& editor,
                                  PosedPoints& posed);

/// Splits an edge and pins the new point on the posed edge. @return kNone if its faces cannot be
/// split.
[[nodiscard]] Index split_posed_edge(Index half_edge, double fraction, SurfaceEditor& editor,
                                     PosedPoints& posed);

}  // namespace sunder::tear
