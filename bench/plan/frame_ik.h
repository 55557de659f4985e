#pragma once

#include <sunder/plan/plan.h>

#include <vector>

#include "pipeline/plan/target_path.h"

namespace sunder::bench {

/// What programs without plans do: inverse kinematics for each sample of the moving target alone,
/// by damped least squares with differences, each from the one before, clamped to limits.
/// @param samples  at the rate of the trajectory.
[[nodiscard]] RobotTrajectory frame_ik(const PlanTool& tool,
                                       const std::vector<plan::TargetSample>& samples,
                                       const std::vector<double>& middle);

}  // namespace sunder::bench
