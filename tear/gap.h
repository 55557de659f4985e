#pragma once

#include <functional>
#include <vector>

#include "tear/imprint_sheets.h"

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

/// Removes what lies inside a convex cell from some faces: the faces inside go, those that reach out of it are clipped.
GapRemoval remove_cell(const Cell& cell, const std::vector<Index>& faces, SurfaceEditor& editor, PosedPoints& posed);

}  // namespace sunder::tear
