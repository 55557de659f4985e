#pragma once

#include <Eigen/Core>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// What counts as an error of one.
struct ErrorScales {
  double place = 1e-4;  ///< Metres.
  double depth = 1e-3;  ///< Metres.
  double angle = 0.05;  ///< Radians.
};

/// How far a blade is from where it shall be: three numbers for the distance of the blade's line
/// from the place on the curve, one for the depth, three for the direction.
using BladeErrors = Eigen::Matrix<double, 7, 1>;
using ErrorRates = Eigen::Matrix<double, 7, Eigen::Dynamic>;

/// The scales at a sample: above the surface the place counts less.
[[nodiscard]] ErrorScales scales_at(const ErrorScales& scales, const TargetSample& sample);

/// @param rates  if not null, written: changes of the errors per change of each value.
[[nodiscard]] BladeErrors blade_errors(const BladePlace& blade, const TargetSample& sample,
                                       const ErrorScales& scales, ErrorRates* rates);

/// The same in metres and radians.
struct PlainErrors {
  double place = 0, depth = 0, angle = 0;
  double tip_depth = 0;  ///< Metres below the surface.
  bool is_base_outside = false;
};
[[nodiscard]] PlainErrors plain_errors(const BladePlace& blade, const TargetSample& sample);

}  // namespace sunder::plan
