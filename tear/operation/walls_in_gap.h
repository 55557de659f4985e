#pragma once

#include <span>

#include "tear/geometry/blade_plane.h"
#include "tear/posed/workpiece.h"
#include "tear/sheet/gap.h"

namespace sunder::tear {

/// Removes the walls below the parts of lips that lie inside a cell, down to their lower borders: a
/// cell takes only what is inside it, and walls lean out of it.
/// @param faces  the faces of which the cell will remove a part.
/// @return whether there are any; the faces may have changed then.
bool remove_walls_in_gap(std::span<const PlaneSide> cell, std::span<const CellFace> faces,
                         const BladePlane& plane, const Workpiece& work);

}  // namespace sunder::tear
