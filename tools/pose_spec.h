#pragma once

#include <sunder/core/character.h>
#include <sunder/io/operation_log.h>

namespace sunder::tools {

/// The pose that an operation names.
/// @return not_found for a clip or bone that the character does not have.
Result<ModelPose> make_pose(const Character& character, const PoseSpec& spec);

}  // namespace sunder::tools
