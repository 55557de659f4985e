#pragma once

#include <sunder/io/robot_file.h>
#include <sunder/operation/operation.h>
#include <sunder/robot/trajectory.h>

#include <string>
#include <vector>

#include "tools/messages/exit_code.h"
#include "tools/messages/json.h"
#include "tools/messages/messages.h"
#include "tools/picture/posed_robot.h"
#include "tools/verbs.h"

namespace sunder::tools {

/// A tear that the blade of a robot makes.
struct RobotTear {
  LoadedRobot robot;
  TearOperation tear;
  double first_time = 0, last_time = 0;  ///< Of the blades, seconds.
  std::vector<double> times = {};        ///< Of each blade, seconds.
  ModelPose last_pose;                   ///< Of the robot's character, in the character's space.
  std::vector<std::string> warnings;     ///< Of the file, and of exceeded limits.
  Json excesses = Json::array();
};

/// Loads the robot and its trajectory and sweeps the blade.
/// @param reading  of the robot.
/// @return ok, or the exit code of the failure, which was reported.
[[nodiscard]] ExitCode make_robot_tear(const RobotTearRequest& request, const ModelReading& reading,
                                       const Character& character, const Messages& messages,
                                       RobotTear& made);

/// Loads the robot and poses it as it stands at the end of its trajectory; at rest without one.
/// @return as make_robot_tear().
[[nodiscard]] ExitCode place_robot(const RobotTearRequest& request, const ModelReading& reading,
                                   const Messages& messages, RobotTear& made);

/// For the report.
[[nodiscard]] Json robot_tear_json(const RobotTearRequest& request, const RobotTear& made);

/// For the picture.
[[nodiscard]] PosedRobot posed_robot(const RobotTear& made);

}  // namespace sunder::tools
