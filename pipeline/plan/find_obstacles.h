#pragma once

#include <span>
#include <vector>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/blade_errors.h"
#include "pipeline/plan/inverse_kinematics.h"
#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// Whether the blade passes the surface within a distance of the sample, about as deep as it shall.
[[nodiscard]] bool is_reached(BladeChain& chain, const TargetSample& sample, const Values& values,
                              double tolerance);

/// The longest part of the cut in which the blade passes the surface within a distance of the
/// curve, about as deep as it shall.
struct ReachedPart {
  bool is_whole = false;           ///< False without a sample below the surface.
  std::size_t first = 0, end = 0;  ///< Samples; empty: none.
};
/// @param values  per sample.
[[nodiscard]] ReachedPart reached_part(BladeChain& chain, std::span<const TargetSample> samples,
                                       std::span<const Values> values, double tolerance);

/// What keeps the blade from the sample next to a part: each limit that, taken away alone, lets
/// joints reach it; otherwise limits that let them reach it together; otherwise the reach.
/// @param values  with the least errors at that sample.
/// @return empty if values within limits reach the sample.
[[nodiscard]] std::vector<PlanObstacle> find_obstacles(BladeChain& chain,
                                                       const TargetSample& sample,
                                                       const ErrorScales& scales,
                                                       const ValueLimits& limits,
                                                       const Values& values, double tolerance);

}  // namespace sunder::plan
