#pragma once

#include <sunder/plan/plan.h>

#include <functional>

namespace sunder::plan {

/// The inputs of a plan without some obstacles.
struct FreedInputs {
  PlanTool tool;
  PlanOptions options;
};

/// The inputs without the links that a report names, and with ten times the speeds and the
/// accelerations that it names.
[[nodiscard]] FreedInputs freed_inputs(const PlanTool& tool, const PlanOptions& options,
                                       const PlanReport& report);

/// Plans without what a report names, and adds what stops that plan in the same way, until the
/// curve is made, or something of another kind stops it, or nothing new does. Links, speeds and
/// accelerations only.
/// @param plan    of freed inputs.
/// @param report  not reachable.
[[nodiscard]] Status confirm_causes(
    const PlanTool& tool, const PlanOptions& options,
    const std::function<Result<PlannedMotion>(const FreedInputs&)>& plan, PlanReport& report);

}  // namespace sunder::plan
