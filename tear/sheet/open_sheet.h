#pragma once

#include <vector>

#include "tear/geometry/half_space.h"
#include "tear/posed/workpiece.h"
#include "tear/surface/open.h"

namespace sunder::tear {

/// What opening the surface along a sheet came to.
struct SheetOpening {
  std::vector<PointEdge> edges;    ///< As they were before they opened: the left lip is at the left of each.
  std::vector<Index> left, right;  ///< Half-edges of the faces at both sides of the edges: the borders of the lips.
  Index runs = 0;                  ///< Of edges that hang together.
  Index faces_crossed = 0;
  Index blocked = 0;
  double length_posed = 0;
};

/// The live faces on both sides of whose plane there are corners, and which no bound shuts out, ascending.
[[nodiscard]] std::vector<Index> faces_across(const Sheet& sheet, const SurfaceEditor& editor, PosedPoints& posed);

/// Opens the posed surface, every layer of it, where it meets a sheet.
[[nodiscard]] SheetOpening open_sheet(const Sheet& sheet, const Workpiece& work, std::vector<LipPair>& lips);

}  // namespace sunder::tear
