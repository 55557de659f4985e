#pragma once

#include <sunder/core/math.h>

#include <span>

#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// Lines a bore. Each rim around the axis that faces the drill is joined to the next one below it
/// that faces away; a rim without such a partner gets a wall down to the end of the bore, and a
/// floor. Open rims stay as they are.
/// @param material  of the wall; kNone: that of the rim.
/// @return the number of rims that stay as they are.
Index add_bore_wall(std::span<const Index> half_edges, const Vec3d& origin, const Vec3d& axis,
                    double depth, Index material, const Workpiece& work);

}  // namespace sunder::tear
