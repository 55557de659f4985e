#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// @return size_mismatch or non_finite_value if a pose is none of the character.
[[nodiscard]] Status check_pose(const CharacterLink& character, const ModelPose& pose);

}  // namespace sunder::particles
