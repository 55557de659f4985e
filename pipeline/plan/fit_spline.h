#pragma once

#include <span>
#include <vector>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/blade_errors.h"
#include "pipeline/plan/clearance.h"
#include "pipeline/plan/inverse_kinematics.h"
#include "pipeline/plan/joint_spline.h"
#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// What links keep away from.
struct KeptAway {
  std::span<const BoneCollider> shapes;
  std::vector<NearPlace> places;
  double margin = 0;  ///< Metres.
};

/// The spline nearest to values within limits, where the search begins.
/// @param values  one per sample.
[[nodiscard]] JointSpline spline_through(std::span<const Values> values,
                                         std::span<const TargetSample> samples,
                                         std::vector<double> knots, const ValueLimits& limits);

/// The spline of all values that passes along the samples with small errors, smoothly and within
/// limits: nonlinear least squares by Ceres. Limits of values hold exactly at every time; speeds
/// and accelerations are held by costs, so check them.
/// @param start  where the search begins.
[[nodiscard]] Result<JointSpline> fit_spline(BladeChain& chain,
                                             const std::vector<TargetSample>& samples,
                                             const ErrorScales& scales, const SplineLimits& limits,
                                             const KeptAway& kept_away, JointSpline start);

}  // namespace sunder::plan
