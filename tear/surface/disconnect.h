#pragma once

#include <span>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

// Disconnecting faces: the surface opens.

/// Disconnects the faces on both sides of a half-edge.
void cut_edge(Index half_edge, SurfaceEditor& editor);

/// Gives a fan a point of its own. Vertices that faces of other fans use are duplicated.
/// @param corners    all corners of the fan.
/// @param remaining  one corner of each other fan of the point.
/// @return the new point.
Index separate_fan(std::span<const Index> corners, std::span<const Index> remaining,
                   SurfaceEditor& editor);

/// The half-edges of a cut path at a point: the one that arrives there, the one that leaves, and
/// their former twins.
struct PathThroughPoint {
  Index arriving = kNone, leaving = kNone;
  Index across_arriving = kNone, across_leaving = kNone;
};
/// Gives the fan left of such a path a point of its own.
/// @return the new point; kNone if the point has other fans, borders or several vertices; then
///         nothing is changed.
Index separate_left_fan(const PathThroughPoint& path, SurfaceEditor& editor);

/// Retires a triangle whose edges are all cut. The caller updates `point_corner` of its points.
void retire_triangle(Index triangle, SurfaceEditor& editor);

}  // namespace sunder::tear
