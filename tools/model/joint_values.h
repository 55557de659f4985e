#pragma once

#include <sunder/core/skeleton.h>
#include <sunder/core/status.h>

#include <filesystem>
#include <string>
#include <vector>

namespace sunder::tools {

/// The pose of a robot's character at the values of --joints: "elbow=0.3", "gripper=0.02", radians
/// and metres; "elbow.x=0.3" of a joint with several values. Values that are not given are at rest.
/// @param model  the robot's file.
/// @return the failures of load_robot() and RobotMotion::create(): not_found for an unknown name,
/// with the nearest ones; invalid_argument for a file that is no robot, a text that is not
/// NAME=VALUE, and a value outside of its limits.
[[nodiscard]] Result<ModelPose> pose_of_joints(const std::vector<std::string>& texts,
                                               const std::filesystem::path& model);

}  // namespace sunder::tools
