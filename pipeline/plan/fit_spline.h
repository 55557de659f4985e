#pragma once

#include <span>
#include <vector>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/blade_errors.h"
#include "pipeline/plan/inverse_kinematics.h"
#include "pipeline/plan/joint_spline.h"
#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// The spline of all values that passes along the samples with small errors, smoothly and within
/// limits: nonlinear least squares by Ceres. Limits of values hold exactly at every time; speeds
/// and accelerations are held by costs, so check them.
/// @param start  values per sample, where the search begins.
[[nodiscard]] Result<JointSpline> fit_spline(BladeChain& chain,
                                             const std::vector<TargetSample>& samples,
                                             const ErrorScales& scales, const SplineLimits& limits,
                                             std::span<const Values> start, std::size_t intervals);

}  // namespace sunder::plan
