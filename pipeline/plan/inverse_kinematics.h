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

/// Values for each sample in turn, each found from the one before. The search begins in the middle
/// of the motion, with random starts, and follows each of several different solutions there: elbow
/// up, elbow down, and others.
/// @param samples  at least one; at even times.
/// @return at most three tracks, at least one, of one entry per sample: those with the least sums
///         of errors and of speeds beyond limits first.
[[nodiscard]] std::vector<std::vector<Values>> track_samples(BladeChain& chain,
                                                             std::span<const TargetSample> samples,
                                                             const ErrorScales& scales,
                                                             const SplineLimits& limits,
                                                             std::uint32_t seeds);

}  // namespace sunder::plan
