#pragma once

#include <sunder/core/character.h>

#include <cstdint>
#include <functional>

#include "tools/open/opening.h"

namespace sunder::tools {

/// The material of a wall beside a submesh of a mesh, as Submesh::material.
using WallMaterial = std::function<std::uint32_t(std::uint32_t mesh, std::uint32_t submesh)>;

/// Appends the walls of an opening to a torn character and to the opening's meshes. Walls of a
/// material that differs from their lip's have texture coordinates of their own and white vertex
/// colours; the others look as the lip.
/// @param character  as for with_open_target().
/// @return size_mismatch; the failures of compute_palette().
[[nodiscard]] Status add_wound_walls(const WallMaterial& material_of, Opening& opening,
                                     Character& character);

/// Likewise its threads, of a material of their own.
[[nodiscard]] Status add_wound_threads(std::uint32_t material, Opening& opening,
                                       Character& character);

}  // namespace sunder::tools
