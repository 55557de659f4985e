#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/messages/json.h"
#include "tools/plan/plan_request.h"

namespace sunder::tools {

/// The report as JSON.
/// @param base  from where the robot could make all of the curve, if it is known.
[[nodiscard]] Json plan_json(const PlanRequest& request, const PlanReport& report,
                             const std::optional<PlannedBase>& base);

/// The value of --robot-place from where the robot could make the curve.
[[nodiscard]] Vec3d place_of_base(const PlanRequest& request, const PlannedBase& base);

/// The lines of the summary.
[[nodiscard]] std::string plan_summary(const PlanReport& report);

/// "joint 'elbow' would have to leave its limits, at 34 % of the curve".
[[nodiscard]] std::string obstacle_text(const PlanObstacle& obstacle);

}  // namespace sunder::tools
