#pragma once

#include <span>
#include <vector>

#include "tear/geometry/half_space.h"
#include "tear/posed/posed_points.h"
#include "tear/surface/open.h"

namespace sunder::tear {

/// What making sheets edges of the surface came to.
struct SheetImprint {
  /// Of each sheet: the edges in which it meets the faces, directed so that the inside of its plane
  /// is at their left.
  std::vector<std::vector<PointEdge>> edges;
  Index faces_crossed = 0;
  Index blocked = 0;  ///< Faces across which an edge could not be made, because they are too small
                      ///< or degenerate.
};

/// Makes the lines in which sheets meet faces edges of the surface, as the faces stand in the pose.
/// Lines end where the sheets do, also within a face; nothing beyond them is split. Sheets that
/// bound one another meet in corners. After it the children of each face (Stage::ancestor) lie on
/// one side of each sheet.
///
/// @param faces  live ones, each once.
/// O((faces + new points) x sheets). Points go nowhere but onto the lines: a crossing that would be
/// stored as an edge's end, or is nearer to it than 1e-9 of the edge's length, is that end.
[[nodiscard]] SheetImprint imprint_sheets(std::span<const Sheet> sheets,
                                          std::span<const Index> faces, SurfaceEditor& editor,
                                          PosedPoints& posed);

}  // namespace sunder::tear
