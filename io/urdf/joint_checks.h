#pragma once

#include <sunder/robot/robot.h>

#include <optional>
#include <string_view>

#include "io/urdf/findings.h"
#include "io/urdf/tags.h"

namespace sunder::urdf {

/// The type of that name in URDF.
[[nodiscard]] std::optional<RobotJointType> joint_type_named(std::string_view name);

/// Checks and repairs what each joint says of itself: type, axis, limits. Afterwards urdfdom
/// accepts every joint that has no error.
void repair_joints(RobotTags& tags, Findings& findings);

}  // namespace sunder::urdf
