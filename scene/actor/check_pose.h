#pragma once

#include <sunder/core/character.h>

namespace sunder::scene {

/// Whether a pose has the sizes that a character needs, and is finite.
[[nodiscard]] Status check_pose(const Character& character, const ModelPose& pose);

}  // namespace sunder::scene
