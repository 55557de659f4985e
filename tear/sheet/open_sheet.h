#pragma once

#include <array>
#include <span>
#include <vector>

#include "tear/geometry/plane_side.h"
#include "tear/posed/workpiece.h"
#include "tear/surface/open.h"

namespace sunder::tear {

/// Result of opening the surface along a sheet.
struct SheetOpening {
  /// The edges before they opened; the left lip is on the left of each edge.
  ScratchVector<PointEdge> edges;
  /// If asked for, half-edges of the faces on both sides of the edges: the borders of the lips.
  ScratchVector<Index> left, right;
  /// Where the section touches itself: half-edges of the borders and the ones that follow them
  /// around the section, ascending. Several fans share the points there until the caps join them;
  /// see separate_loose_fans().
  ScratchVector<std::array<Index, 2>> left_following, right_following;
  Index runs = 0;  ///< Number of connected runs of edges.
  Index faces_crossed = 0;
  Index blocked = 0;
  double length_posed = 0;
};

/// The live faces, ascending, that have corners on both sides of the sheet's plane, or at least two
/// on it, and that no bound excludes.
[[nodiscard]] ScratchVector<Index> faces_across(const Sheet& sheet, const SurfaceEditor& editor,
                                                PosedPoints& posed);

/// Opens the posed surface where some faces meet a sheet.
/// @param faces  of faces_across(): all of them, or those of some sections.
/// @param keeps_borders  whether SheetOpening::left and right are wanted.
[[nodiscard]] SheetOpening open_sheet(const Sheet& sheet, std::span<const Index> faces,
                                      bool keeps_borders, const Workpiece& work,
                                      std::vector<LipPair>& lips);

}  // namespace sunder::tear
