#pragma once

#include <sunder/operation/operation.h>

#include <vector>

#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// Gives borders inner walls, so that one looks into tissue and not through the shell: a strip that
/// hangs from each border half-edge to `depth` below it, the way the blade went. It has a submesh
/// of its own ("wall"), texture coordinates (u along the rim, v down, both in depths), and the
/// weights of the lips.
/// @param half_edges  borders.
/// @param stroke      the blades that opened them: at each point the direction of the blades near
/// it.
/// @return how many rims got walls.
Index add_walls(const std::vector<Index>& half_edges, const Stroke& stroke, double depth,
                const Workpiece& work);

/// Lines a bore: each rim around the axis that looks to the drill is joined to the next one below
/// it that looks away; one that has none gets a wall down to the end of the bore, and a floor. Rims
/// that do not close stay as they are.
/// @return how many rims stay as they are.
Index add_bore_wall(const std::vector<Index>& half_edges, const Vec3d& origin, const Vec3d& axis,
                    double depth, const Workpiece& work);

}  // namespace sunder::tear
