#pragma once

#include <optional>

#include "tear/path/surface_hit.h"
#include "tear/path/sweep.h"

namespace sunder::tear {

/// A straight part of a path through faces that are parts of one source triangle. The edges
/// between these faces only belong to the triangulation that earlier tears left. They are flipped
/// out of the way, because splitting them would add points that nothing needs.
struct Leap {
  /// The end: at a point, on an edge that must be split, or where the reach of the blade ends.
  SurfaceHit landing;
  Index edges = 0;      ///< Number of edges in the way.
  double progress = 0;  ///< Progress in the sweep at its end.
  std::optional<PathEnd> end;
};

/// Looks ahead beyond the edge that a step goes to. Changes nothing.
[[nodiscard]] Leap find_leap(const BladePlane& plane, const Step& step, const SurfaceEditor& editor,
                             PosedPoints& posed);

/// Makes the way from `here` to the landing an edge.
/// @return the point at the landing; kNone, and nothing changed, if no edge is in the way or an
///         edge cannot be flipped.
[[nodiscard]] Index take_leap(const BladePlane& plane, Index here, const Leap& leap,
                              SurfaceEditor& editor, PosedPoints& posed);

}  // namespace sunder::tear
