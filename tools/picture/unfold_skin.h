#pragma once

#include <vector>

#include "tools/picture/surface_points.h"

namespace sunder::tools {

/// Moves the surface beside lips along with them where a lip has passed over it, so that no
/// triangle is turned over, and turns its normals. A lip is moved by all the tension that acts on
/// it, a point beside it only by the particles that the two share; where a point of the source is
/// nearer to the lip than the lip moves, the triangles between them fold. Lips themselves move only
/// where that alone does not unfold them, by a part of what they moved.
/// @param from          the surface of `closed`.
/// @param closed, open  in one pose, of the instance.
void unfold_skin(const CharacterInstance& instance, const SurfacePoints& from,
                 const std::vector<DeformedMesh>& closed, std::vector<DeformedMesh>& open);

}  // namespace sunder::tools
