#pragma once

#include "tear/path/surface_hit.h"
#include "tear/path/sweep.h"

namespace sunder::tear {

/// The curve in which a blade's plane meets the surface.
struct Trace {
  explicit Trace(ScratchMemory& memory) : faces(&memory), section(&memory) {}

  ScratchVector<Index> faces;    ///< Faces crossed, in order.
  ScratchVector<Vec2d> section;  ///< Corners of the curve in the plane, ascending by progress.
  double length_posed = 0;
  double progress = 0;  ///< Progress in the sweep at its end.
  PathEnd end = PathEnd::surface;
  SurfaceHit end_place;  ///< The end, if it is at the blade.
};

/// Follows the curve as imprint_path() does, but changes nothing: from a point on, face to face,
/// while it goes forward in the sweep and the blade reaches it.
[[nodiscard]] Trace trace_path(const BladePlane& plane, Index start, const SurfaceEditor& editor,
                               PosedPoints& posed);

}  // namespace sunder::tear
