#pragma once

#include <sunder/core/character.h>

#include <vector>

#include "tools/model/posed_model.h"

namespace sunder::tools {

/// Per mesh and triangle: whether it encloses something, that is, whether most rays from it inwards
/// meet the inside of another triangle. Skin of a body and its limbs does; single sheets, such as
/// ears, cloth and hair, do not. Retired triangles do not.
///
/// O(triangles x log triangles). @throws std::bad_alloc
/// @param posed  of the meshes.
[[nodiscard]] std::vector<std::vector<bool>> enclosing_faces(
    const Character& character, const std::vector<DeformedMesh>& posed);

}  // namespace sunder::tools
