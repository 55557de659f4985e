#pragma once

#include <sunder/core/character.h>
#include <sunder/skinning/deform.h>

namespace sunder::tools {

/// The morph target that takes a posed mesh from `from` to `to`: displacements in model space,
/// carried back into bind space through the skinning of each vertex, so that linear blend skinning
/// in this pose gives `to` up to rounding. Normals and tangents likewise, as far as the mesh has
/// them. Vertices that are equal in both get zeros, as do those whose bones flatten space there.
/// @param from  as the pose alone puts the vertices; with the arrays of `to`.
/// @return without arrays if nothing is displaced; the failures of compute_palette().
[[nodiscard]] Result<MorphTarget> displacement_in_bind(const Character& character,
                                                       std::uint32_t mesh, const ModelPose& pose,
                                                       const DeformedMesh& from,
                                                       const DeformedMesh& to);

}  // namespace sunder::tools
