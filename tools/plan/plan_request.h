#pragma once

#include <sunder/plan/plan.h>

#include <filesystem>
#include <optional>

#include "tools/verbs.h"

namespace sunder::tools {

/// sunder plan: finds the motion of a robot or a hand that makes a wound.
struct PlanRequest {
  std::filesystem::path model, curve;
  std::optional<std::filesystem::path> like;  ///< In place of a curve: a model with a wound.
  double like_depth = 0.01;                   ///< How deep the blade goes for it, metres.
  /// The robot, its blade and place, the pose and the clip's speed; the trajectory is the output.
  RobotTearRequest robot;
  std::optional<std::filesystem::path> hand;  ///< Output: a hand as URDF, in place of a robot.
  double hand_blade = 0.1;                    ///< Length of its blade, metres.
  PlanTiming timing;                          ///< But for the pose and the clip's speed.
  PlanOptions options;
  /// A trajectory of the robot, or a log, that is compared with the curve in place of a plan.
  std::optional<std::filesystem::path> score;
  double score_rate = 0;  ///< Blades per second of that log; 0: not known.
  std::optional<std::filesystem::path> tear, picture, report;  ///< Outputs.
  Verbosity verbosity = Verbosity::normal;
  ModelReading reading;
  BudgetLimits budget;
};

}  // namespace sunder::tools
