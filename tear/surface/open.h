#pragma once

#include <sunder/tear/change_record.h>

#include <array>
#include <span>
#include <vector>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// A directed edge between two points.
using PointEdge = std::array<Index, 2>;

/// Opens the surface along edges: both sides of each edge are disconnected, and each point whose
/// faces fall apart into several fans becomes several points. Faces right of the edges keep their
/// points; a point whose faces stay together is a tip.
///
/// @param edges  of the surface, directed; an edge that the surface does not have, or that is a
/// border, has nothing to open.
/// @param half_edges  where known, the half-edge of each; what does not fit is looked up.
/// @param lips  appended: left and right points in the order of the edges.
void open_edges(std::span<const PointEdge> edges, std::span<const Index> half_edges,
                SurfaceEditor& editor, std::vector<LipPair>& lips);

}  // namespace sunder::tear
