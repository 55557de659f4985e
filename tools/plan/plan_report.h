#pragma once

#include <string>
#include <vector>

#include "tools/messages/json.h"
#include "tools/plan/plan_request.h"

namespace sunder::tools {

/// The report as JSON.
[[nodiscard]] Json plan_json(const PlanRequest& request, const PlanReport& report);

/// The lines of the summary.
[[nodiscard]] std::string plan_summary(const PlanReport& report);

/// "joint 'elbow' would have to leave its limits, at 34 % of the curve".
[[nodiscard]] std::string obstacle_text(const PlanObstacle& obstacle);

}  // namespace sunder::tools
