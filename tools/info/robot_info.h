#pragma once

#include <sunder/io/robot_file.h>

#include <span>
#include <string>

#include "tools/messages/json.h"
#include "tools/messages/lines.h"

namespace sunder::tools {

/// Links, joints and values of a robot.
[[nodiscard]] Json robot_json(const Robot& robot);
[[nodiscard]] Json findings_json(std::span<const RobotFinding> findings);

/// The tree of links with their joints and limits, one link per line.
[[nodiscard]] Lines robot_text(const Robot& robot);
/// One finding per line: severity, code, line, place, text.
[[nodiscard]] Lines findings_text(std::span<const RobotFinding> findings);

}  // namespace sunder::tools
