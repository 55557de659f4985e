#pragma once

#include <sunder/operation/operation.h>

#include <span>

#include "tear/filling/wall_ends.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// How the lips of a stroke get walls.
struct LipWallOptions {
  double depth = 0;  ///< Posed metres, > 0.
  double width = 0;  ///< Of the gap.
  double roll = 0;   ///< Radius of the rims with which walls begin.
  Index material = kNone;
  bool all_layers = false;  ///< Walls of layers that the blade leaves go back into the body.
  /// Lips nearer than this to `front` get no walls yet, because the tear may still change there.
  double hold = 0;
  Blade front;
};

/// Gives lips inner walls, so that one sees tissue instead of the inside of the shell. A wall leans
/// under the opposite lip: what is seen of two opposite walls ends where they cross. It tapers to
/// nothing at tips, and reaches at most half as deep as the body is thick there. It has a submesh
/// of its own ("wall"), texture coordinates (u along the rim from its first tip, v downwards, both
/// in units of the depth), and the weights of the lips.
/// @param half_edges  borders.
/// @param stroke      the blades that opened them; each point uses the direction of the nearest
///         ones.
/// @param walls       of the earlier calls; written.
/// @return the number of strips that were added.
Index add_lip_walls(std::span<const Index> half_edges, const Stroke& stroke,
                    const LipWallOptions& options, LipWalls& walls, const Workpiece& work);

}  // namespace sunder::tear
