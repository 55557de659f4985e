#pragma once

#include <span>

#include "tear/sheet/cell_sides.h"

namespace sunder::tear {

/// Result of imprinting a cell in the surface.
struct CellImprint {
  Index faces_crossed = 0;
  /// Number of faces across which an edge could not be made, because they are too small or
  /// degenerate.
  Index blocked = 0;
  /// Whether a child of one face may cover a part of its neighbour.
  bool has_turned_edges = false;
};

/// Turns the lines in which the sides of a convex cell meet posed faces into edges of the surface.
/// Afterwards each child of a face (Stage::ancestor) lies inside the cell or outside of it. Nothing
/// outside the cell is split, except that faces on both sides of a split edge are. For one plane
/// with other bounds there is imprint_sheets().
///
/// @param faces  live faces, each once, ascending. O(faces + new points), and per face the
///         half-spaces that do not contain all of it. A crossing snaps to an end of its edge only
///         if it would be stored as that end or is nearer to it than 1e-9 of the edge's length.
[[nodiscard]] CellImprint imprint_cell(CellSides& sides, std::span<const CellFace> faces,
                                       SurfaceEditor& editor);

}  // namespace sunder::tear
