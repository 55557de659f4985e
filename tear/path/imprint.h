#pragma once

#include "tear/path/sweep.h"

namespace sunder::tear {

/// A run of surface edges along which the surface is to open.
struct Path {
  explicit Path(ScratchMemory& scratch) : points(&scratch), half_edges(&scratch) {}

  ScratchVector<Index> points;
  ScratchVector<Index> half_edges;  ///< Between them, where known; they may have moved since.
  Index faces_crossed = 0;
  double length_posed = 0;
  double progress = 0;  ///< In the sweep, of the end of the curve.
  PathEnd end = PathEnd::surface;
};

/// Makes the curve in which the plane meets the surface a run of edges: from `start` on, face to
/// face, while it goes forward in the sweep and the blade reaches it.
[[nodiscard]] Path imprint_path(const BladePlane& plane, Index start, SurfaceEditor& editor,
                                PosedPoints& posed);

}  // namespace sunder::tear
