#pragma once

#include <sunder/plan/plan.h>

#include <span>
#include <vector>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/inverse_kinematics.h"
#include "pipeline/plan/joint_spline.h"
#include "pipeline/plan/target_path.h"
#include "pipeline/plan/timeline.h"

namespace sunder::plan {

/// A spline as 240 samples a second, and at least 240 in the cut; within limits.
[[nodiscard]] RobotTrajectory trajectory_of(const JointSpline& spline, const BladeChain& chain,
                                            const Timeline& timeline, const ValueLimits& limits);

/// A value's margin during a trajectory, and where on the curve it is fastest and turns sharpest.
struct PlacedMargin {
  ValueMargin margin;
  double fastest_share = 0, sharpest_share = 0;
};
[[nodiscard]] PlacedMargin margin_of(const BladeChain& chain, std::size_t value,
                                     const RobotTrajectory& trajectory, const Timeline& timeline);

/// Writes the errors of place, depth and angle at the samples of the cut.
void measure_errors(const JointSpline& spline, std::span<const TargetSample> samples,
                    BladeChain& chain, PlanReport& report);

}  // namespace sunder::plan
