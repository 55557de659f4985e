#pragma once

#include <sunder/core/math.h>
#include <sunder/core/status.h>

#include <vector>

#include "tools/verbs.h"

namespace sunder::tools {

/// The pose of the robot of a binding at the joint values that the request names: one matrix per
/// link, in the space of its character.
/// @return the failures of load_robot() and RobotMotion::create(); invalid_argument for a text that
/// is not NAME=VALUE, or a value outside of its limits.
[[nodiscard]] Result<std::vector<Affine3d>> pose_of_joints(const BindRequest& request);

}  // namespace sunder::tools
