#pragma once

#include <optional>

#include "tear/path/surface_hit.h"
#include "tear/path/sweep.h"

namespace sunder::tear {

/// The way of a path straight on through faces that are parts of one source triangle. The edges
/// between them are those of earlier tears' triangulation and of no interest: they are turned out
/// of the way, where a split would leave a point that nobody needs.
struct Leap {
  SurfaceHit landing;   ///< At a point, on an edge that has to be split, or where the reach of the
                        ///< blade ends.
  Index edges = 0;      ///< In the way.
  double progress = 0;  ///< In the sweep, of its end.
  std::optional<PathEnd> end;
};

/// Looks ahead beyond the edge that a step goes to.
[[nodiscard]] Leap find_leap(const BladePlane& plane, const Step& step, const SurfaceEditor& editor,
                             PosedPoints& posed);

/// Makes the way from `here` an edge.
/// @return where it leads to; kNone where there is no edge in the way or one cannot be turned:
/// nothing changed.
[[nodiscard]] Index take_leap(const BladePlane& plane, Index here, const Leap& leap,
                              SurfaceEditor& editor, PosedPoints& posed);

}  // namespace sunder::tear
