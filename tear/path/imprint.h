#pragma once

#include "tear/path/sweep.h"

namespace sunder::tear {

/// A run of surface edges along which the surface will be opened.
struct Path {
  explicit Path(ScratchMemory& scratch) : points(&scratch), half_edges(&scratch) {}

  ScratchVector<Index> points;
  /// Half-edges between the points where they are known; they may have moved since.
  ScratchVector<Index> half_edges;
  Index faces_crossed = 0;
  double length_posed = 0;
  /// Progress in the sweep at the end of the curve.
  double progress = 0;
  PathEnd end = PathEnd::surface;
  /// Progress of the last crossing before it snapped, which may be to a point beyond.
  double crossing_progress = 0;
  bool is_on_wall = false;  ///< Whether it began on a wall. Other paths end at walls.
  /// Whether it runs along a lip, where nothing is to be opened. Other paths end there.
  bool is_along_lip = false;
};

/// Turns the curve in which the plane meets the surface into a run of edges: from `start` from face
/// to face, while it goes forward in the sweep and the blade reaches it.
[[nodiscard]] Path imprint_path(const BladePlane& plane, Index start, SurfaceEditor& editor,
                                PosedPoints& posed);

}  // namespace sunder::tear
