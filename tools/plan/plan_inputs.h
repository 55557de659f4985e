#pragma once

#include <sunder/io/robot_file.h>
#include <sunder/plan/plan.h>

#include <string>

#include "tools/messages/messages.h"
#include "tools/plan/plan_request.h"

namespace sunder::tools {

/// What is read, and what is made of it.
struct PlanInputs {
  LoadedCharacter loaded;
  WoundTarget target;
  PlanTiming timing;
  PlanTool tool;
  std::string hand;  ///< The text of --hand.
};

/// Reads the model, the pose and the curve.
[[nodiscard]] ExitCode read_character(const PlanRequest& request, const Messages& messages,
                                      PlanInputs& inputs);

/// Reads the robot that carries the blade, and fits shapes to its links.
[[nodiscard]] ExitCode read_robot(const PlanRequest& request, const Messages& messages,
                                  PlanInputs& inputs);

}  // namespace sunder::tools
