#pragma once

#include <array>
#include <functional>
#include <vector>

#include "tear/sheet/imprint_sheets.h"

namespace sunder::tear {

/// The live faces of which a part lies inside a cell, ascending.
[[nodiscard]] std::vector<Index> faces_in_cell(const Cell& cell, const SurfaceEditor& editor,
                                               PosedPoints& posed);

/// The same, restricted to faces that are connected to the seeds inside the cell.
/// @param is_wanted  whether the search may enter a face.
[[nodiscard]] std::vector<Index> faces_in_cell(const Cell& cell, const std::vector<Index>& seeds,
                                               const std::function<bool(Index face)>& is_wanted,
                                               const SurfaceEditor& editor, PosedPoints& posed);

/// Figures of the removal of a cell.
struct GapRemoval {
  Index faces_crossed = 0;
  Index faces_removed = 0;
  Index blocked = 0;
  double area_posed = 0;
};

/// The border that the removal of a cell left.
struct CellRim {
  struct Edge {
    std::array<Index, 2> points = {};
    /// The half-space of the cell on whose plane the edge lies; kNone for an edge inside the cell.
    Index side = kNone;
    Index part = 0;
  };
  std::vector<Edge> edges;
  /// Per removed part (faces connected by edges): the sum of the posed area vectors of its faces.
  std::vector<Vec3d> areas;
};

/// Removes the part of some faces that lies inside a convex cell. Faces inside are removed; faces
/// that reach out of the cell are clipped.
/// @param rim  optional; written.
GapRemoval remove_cell(const Cell& cell, const std::vector<Index>& faces, SurfaceEditor& editor,
                       PosedPoints& posed, CellRim* rim = nullptr);

}  // namespace sunder::tear
