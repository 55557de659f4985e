#pragma once

#include <sunder/core/character.h>

namespace sunder::scene {

/// Whether a pose has the sizes that a character needs, is finite, and no number is above 1e12: in
/// single precision, vertices stay finite too.
[[nodiscard]] Status check_pose(const Character& character, const ModelPose& pose);

}  // namespace sunder::scene
