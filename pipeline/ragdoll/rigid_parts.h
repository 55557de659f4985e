#pragma once

#include <sunder/core/character.h>

#include <span>
#include <vector>

namespace sunder::ragdoll {

/// Per bone: the bone that its part of the surface belongs to, which is the bone itself, or the one
/// above if that moves nothing and this one is the node of a rigid mesh without bones below it:
/// programs write the head of a toy as nodes that hang on the bone "head". If there are clips, a
/// node that one of them moves is no such part, and parts of parts are found.
/// @param bone_of_triangle  of the whole surface, as pose_surface(). @throws std::bad_alloc
[[nodiscard]] std::vector<std::uint32_t> owners_of_parts(
    const Character& character, std::span<const std::uint32_t> bone_of_triangle);

}  // namespace sunder::ragdoll
