#pragma once

#include <sunder/robot/robot.h>

#include <string>
#include <vector>

namespace sunder::tools {

/// The pose of a robot's character from the value of --joints: "elbow=0.3,gripper=0.02", radians
/// and metres; "elbow.x=0.3" of a joint with several values. Values that are not given are at rest.
/// @param model_from_root  as LoadedRobot::model_from_root.
/// @return invalid_argument for other texts and values outside of the limits; not_found for an
/// unknown name.
[[nodiscard]] Result<ModelPose> pose_of_joints(const std::vector<std::string>& texts,
                                               const Robot& robot, const Affine3d& model_from_root);

}  // namespace sunder::tools
