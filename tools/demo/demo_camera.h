#pragma once

#include <sunder/core/character.h>
#include <sunder/skinning/deform.h>

#include <vector>

#include "tools/picture/view.h"
#include "tools/render/camera.h"

namespace sunder::tools {

/// The places of all vertices that triangles use, thinned out.
[[nodiscard]] std::vector<Vec3d> places_of(const Character& character,
                                           const std::vector<DeformedMesh>& posed);

/// Shows the places, with a margin.
/// @param closeness  0: all of them; 1: the wound alone, with its surroundings.
[[nodiscard]] Camera aim(const ViewFrame& frame, const std::vector<Vec3d>& places,
                         const std::vector<Vec3d>& wound, double closeness);

}  // namespace sunder::tools
