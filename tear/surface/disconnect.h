#pragma once

#include <span>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

// Disconnecting faces: the surface opens.

/// Disconnects the faces on both sides of a half-edge.
void cut_edge(Index half_edge, SurfaceEditor& editor);

/// Gives a fan a point of its own. Vertices that faces of other fans use are duplicated.
/// @param corners    all corners of the fan. @param remaining  a corner of each other fan that the
/// point has.
/// @return the new point.
Index separate_fan(std::span<const Index> corners, std::span<const Index> remaining,
                   SurfaceEditor& editor);

/// The half-edges of a path that was cut through a point: those that arrive there and leave, and
/// those across them.
struct PathThroughPoint {
  Index arriving = kNone, leaving = kNone;
  Index across_arriving = kNone, across_leaving = kNone;
};
/// Gives the left one of the two fans on both sides of such a path a point of its own.
/// @return the new point; kNone, and nothing has changed, where the point has other fans, borders
/// or several vertices.
Index separate_left_fan(const PathThroughPoint& path, SurfaceEditor& editor);

/// Takes a triangle away whose edges are all cut. Its points keep no corner of it.
void retire_triangle(Index triangle, SurfaceEditor& editor);

}  // namespace sunder::tear
