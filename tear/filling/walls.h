#pragma once

#include <sunder/operation/operation.h>

#include <span>

#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// Gives borders inner walls, so that one sees tissue instead of the inside of the shell: a strip
/// that extends from each border half-edge to `depth` below it, in the direction of the blade. It
/// has a submesh of its own ("wall"), texture coordinates (u along the rim, v downwards, both in
/// units of the depth), and the weights of the lips.
/// @param half_edges  borders.
/// @param stroke      the blades that opened them; each point uses the direction of the nearest
///         ones.
/// @return the number of rims that got walls.
Index add_walls(std::span<const Index> half_edges, const Stroke& stroke, double depth,
                const Workpiece& work);

/// Lines a bore. Each rim around the axis that faces the drill is joined to the next one below it
/// that faces away; a rim without such a partner gets a wall down to the end of the bore, and a
/// floor. Open rims stay as they are.
/// @return the number of rims that stay as they are.
Index add_bore_wall(std::span<const Index> half_edges, const Vec3d& origin, const Vec3d& axis,
                    double depth, const Workpiece& work);

}  // namespace sunder::tear
