#pragma once

#include <sunder/core/character.h>
#include <sunder/core/named_pose.h>

namespace sunder {

/// The pose that a spec names.
/// @return not_found for a clip or bone that the character does not have; size_mismatch for matrices that are not its bones'.
[[nodiscard]] SUNDER_API Result<ModelPose> make_pose(const Character& character, const PoseSpec& spec);

}  // namespace sunder
