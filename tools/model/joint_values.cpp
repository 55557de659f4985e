#include "tools/model/joint_values.h"

#include <charconv>
#include <cmath>

namespace sunder::tools {
namespace {

Status set_value(const std::string& text, const Robot& robot, std::vector<double>& values) {
  const std::size_t sign = text.rfind('=');
  double value = 0;
  const char* const end = text.data() + text.size();
  const bool is_read = sign != std::string::npos && [&] {
    const auto read = std::from_chars(text.data() + sign + 1, end, value);
    return read.ec == std::errc() && read.ptr == end && std::isfinite(value);
  }();
  if (!is_read)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "'%.80s': expected NAME=VALUE, in radians or metres", text.c_str());
  const std::string name = text.substr(0, sign);
  const std::uint32_t index = find_value(robot, name);
  if (index != kNone) {
    values[index] = value;
    return {};
  }
  const std::uint32_t joint = find_joint(robot, name);
  if (joint == kNone)
    return Status::failure(StatusCode::not_found, kNone, "the robot has no joint '%.80s'",
                           name.c_str());
  return Status::failure(StatusCode::invalid_argument, kNone,
                         "joint '%.80s' has no value of its own, or several (%.80s.x …)",
                         name.c_str(), name.c_str());
}

}  // namespace

Result<ModelPose> pose_of_joints(const std::vector<std::string>& texts, const Robot& robot,
                                 const Affine3d& model_from_root) {
  std::vector<double> values = rest_values(robot);
  for (const std::string& text : texts)
    if (const Status status = set_value(text, robot, values); !status) return status;
  if (const Status status = check_limits(robot, values); !status) return status;
  const Result<RobotKinematics> kinematics = RobotKinematics::create(robot);
  if (!kinematics) return kinematics.error();
  ModelPose pose;
  pose.model_from_bone.resize(robot.links.size());
  if (const Status status = kinematics->evaluate(values, pose.model_from_bone, model_from_root);
      !status)
    return status;
  return pose;
}

}  // namespace sunder::tools
