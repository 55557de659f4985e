#include "tools/bind/joint_pose.h"

#include <sunder/io/robot_file.h>
#include <sunder/robot/trajectory.h>

#include <optional>
#include <string>

#include "tools/model/name_at.h"

namespace sunder::tools {

Result<std::vector<Affine3d>> pose_of_joints(const BindRequest& request) {
  RobotTrajectory one_time{{}, {0.0}, {}};
  for (const std::string& text : request.joints) {
    const std::size_t equals = text.rfind('=');
    const std::optional<double> value =
        equals == std::string::npos ? std::nullopt : number_in(text.substr(equals + 1));
    if (!value)
      return Status::failure(StatusCode::invalid_argument, kNone, "'%.80s': expected NAME=VALUE",
                             text.c_str());
    one_time.names.push_back(text.substr(0, equals));
    one_time.values.push_back(*value);
  }
  RobotLoadOptions load;
  load.package_roots = request.package_roots;
  load.shapes = RobotShapes::none;
  const Result<LoadedRobot> robot = load_robot(request.skeleton, load);
  if (!robot) return robot.error();
  const Result<RobotMotion> motion = RobotMotion::create(robot->robot, one_time);
  if (!motion) return motion.error();
  for (const LimitExcess& excess : motion->excesses()) {
    const RobotValue& value = robot->robot.values[excess.value];
    return Status::failure(StatusCode::invalid_argument, excess.value,
                           "joint '%.80s': %g is outside of its limits, %g to %g",
                           value.name.c_str(), excess.number, value.lower, value.upper);
  }
  std::vector<Affine3d> model_from_link(motion->link_count());
  if (const Status status = motion->pose_at(0.0, model_from_link, robot->model_from_root); !status)
    return status;
  return model_from_link;
}

}  // namespace sunder::tools
