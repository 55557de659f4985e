#pragma once

#include <sunder/tear/change_record.h>

#include <array>
#include <span>
#include <vector>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// A directed edge between two points.
using PointEdge = std::array<Index, 2>;

/// A point in which the section of a body touches itself, and two of the edges there, by their
/// indices, between which the section lies. A cap joins the fans that they bound.
struct SectionCorner {
  Index point = kNone;
  Index arriving = kNone, leaving = kNone;
};

/// Opens the surface along edges: disconnects both sides of each edge, and splits each point whose
/// faces fall apart into several fans into several points. Faces right of the edges keep their
/// points; a point whose faces stay together is a tip.
///
/// @param section_corners  ascending by point. The fans that a cap will join there share a point.
///         The caller caps all of them or calls separate_loose_fans().
/// @param edges  directed; an edge that the surface does not have, or that is a border, is skipped.
/// @param half_edges  the half-edge of each edge where it is known; others are looked up.
/// @param lips  appended: left and right points in the order of the edges.
void open_edges(std::span<const PointEdge> edges, std::span<const Index> half_edges,
                std::span<const SectionCorner> section_corners, SurfaceEditor& editor,
                std::vector<LipPair>& lips);

/// Gives each fan a point of its own, where several fans share one.
/// @param corners  at these points, of all their fans. Sorted.
/// @param lips     appended: the new points and the old ones.
void separate_loose_fans(ScratchVector<Index>& corners, SurfaceEditor& editor,
                         std::vector<LipPair>& lips);

}  // namespace sunder::tear
