#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/blade_errors.h"
#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// Limits of the values that move the blade.
struct ValueLimits {
  Values lower, upper;
};
[[nodiscard]] ValueLimits limits_of(const BladeChain& chain);

struct SplineLimits {
  ValueLimits values;
  Values speed, acceleration;  ///< Per value, per second and second squared; infinity: none.
};

/// Values with small errors at a sample, near `values`: damped least squares (Levenberg 1944,
/// Marquardt 1963) within limits, where a value that a step would push through its limit stays
/// there.
/// @return half the sum of squared errors.
double solve_sample(BladeChain& chain, const TargetSample& sample, const ErrorScales& scales,
                    const ValueLimits& limits, Values& values);

/// A random start: within limits, or within a turn or a metre of rest where there are none.
/// @param state  of next_share().
[[nodiscard]] Values random_values(const Values& rest, const ValueLimits& limits,
                                   std::uint64_t& state);

/// Different values for one sample, from random starts: elbow up, elbow down, and others.
/// @param seeds  number of starts besides the values at rest.
/// @return at least one, those with the least errors first.
[[nodiscard]] std::vector<Values> solutions_of(BladeChain& chain, const TargetSample& sample,
                                               const ErrorScales& scales, const ValueLimits& limits,
                                               std::uint32_t seeds);

}  // namespace sunder::plan
