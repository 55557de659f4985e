#pragma once

#include <sunder/tear/change_record.h>

#include <array>
#include <span>
#include <vector>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// A directed edge between two points.
using PointEdge = std::array<Index, 2>;

/// Opens the surface along edges: disconnects both sides of each edge, and splits each point whose
/// faces fall apart into several fans into several points. Faces right of the edges keep their
/// points; a point whose faces stay together is a tip.
///
/// @param edges  directed; an edge that the surface does not have, or that is a border, is skipped.
/// @param half_edges  the half-edge of each edge where it is known; others are looked up.
/// @param lips  appended: left and right points in the order of the edges.
void open_edges(std::span<const PointEdge> edges, std::span<const Index> half_edges,
                SurfaceEditor& editor, std::vector<LipPair>& lips);

}  // namespace sunder::tear
