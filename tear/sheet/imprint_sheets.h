#pragma once

#include <span>

#include "tear/geometry/plane_side.h"
#include "tear/posed/posed_points.h"
#include "tear/surface/open.h"

namespace sunder::tear {

/// Result of imprinting sheets in the surface. It lies in the scratch memory of the operation.
struct SheetImprint {
  /// Per sheet: the edges in which it meets the faces, directed so that the inside of its plane is
  /// on their left.
  ScratchVector<ScratchVector<PointEdge>> edges;
  Index faces_crossed = 0;
  /// Number of faces across which an edge could not be made, because they are too small or
  /// degenerate.
  Index blocked = 0;
};

/// Turns the lines in which sheets meet posed faces into edges of the surface. Lines end where the
/// sheets end, also within a face; nothing beyond is split. Sheets that bound one another meet in
/// corners. Afterwards each child of a face (Stage::ancestor) lies on one side of each sheet.
///
/// @param faces  live faces, each once. O((faces + new points) x sheets). A crossing snaps to an
///         end of its edge only if it would be stored as that end or is nearer to it than 1e-9 of
///         the edge's length.
[[nodiscard]] SheetImprint imprint_sheets(std::span<const Sheet> sheets,
                                          std::span<const Index> faces, SurfaceEditor& editor,
                                          PosedPoints& posed);

}  // namespace sunder::tear
