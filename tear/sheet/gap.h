#pragma once

#include <array>
#include <functional>
#include <vector>

#include "tear/sheet/imprint_sheets.h"

namespace sunder::tear {

/// The live faces that a cell may hold a part of, ascending.
[[nodiscard]] std::vector<Index> faces_in_cell(const Cell& cell, const SurfaceEditor& editor, PosedPoints& posed);

/// The same, of those that hang together with the seeds inside the cell.
/// @param is_wanted  whether the surface may be followed onto a face.
[[nodiscard]] std::vector<Index> faces_in_cell(const Cell& cell, const std::vector<Index>& seeds,
                                               const std::function<bool(Index face)>& is_wanted, const SurfaceEditor& editor,
                                               PosedPoints& posed);

/// What removing a cell did.
struct GapRemoval {
  Index faces_crossed = 0;
  Index faces_removed = 0;
  Index blocked = 0;
  double area_posed = 0;
};

/// The border that removing a cell left.
struct CellRim {
  struct Edge {
    std::array<Index, 2> points = {};
    Index side = kNone;  ///< The half-space of the cell on whose plane the edge lies; kNone for one inside the cell.
    Index part = 0;
  };
  std::vector<Edge> edges;
  std::vector<Vec3d> areas;  ///< Of each part that went, faces joined by edges: the sum of its faces' posed area vectors.
};

/// Removes what lies inside a convex cell from some faces: the faces inside go, those that reach out of it are clipped.
/// @param rim  written where given.
GapRemoval remove_cell(const Cell& cell, const std::vector<Index>& faces, SurfaceEditor& editor, PosedPoints& posed,
                       CellRim* rim = nullptr);

}  // namespace sunder::tear
