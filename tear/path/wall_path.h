#pragma once

#include "tear/geometry/blade_plane.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// Makes a way down a wall from a point of a lip a run of edges: to the lower border of the wall,
/// or as deep as the blade reaches. A tear that crosses a lip would otherwise leave its sides
/// joined by the wall. The way is at right angles to the lip.
/// @return the points below, downwards; none if there is no wall.
[[nodiscard]] ScratchVector<Index> imprint_wall(const BladePlane& plane, Index point,
                                                SurfaceEditor& editor, PosedPoints& posed);

/// Where the curve in which a blade's plane meets a wall is lowest.
/// @param face  of the wall, crossed by the plane.
/// @return BladePlane::project().y(), metres.
[[nodiscard]] double lowest_of_wall(const BladePlane& plane, Index face,
                                    const SurfaceEditor& editor, PosedPoints& posed);

}  // namespace sunder::tear
