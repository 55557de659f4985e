#pragma once

#include <sunder/validation/validation.h>

#include <cstdint>
#include <vector>

#include "pipeline/validation/checks/skin_points.h"

namespace sunder::validation {

/// The deviation at evenly spaced times of each clip of the source that has a duration.
/// @param differences  one row per vertex of the target: actual minus matched.
/// @param compared     number of vertices that were matched; the others count for nothing.
/// @param most_times   per clip, at least 2; at most 30 per second are taken.
[[nodiscard]] std::vector<ClipDeviation> deviation_over_time(const Character& source,
                                                             const ModelPose& bind,
                                                             const SkinDifferences& differences,
                                                             std::size_t compared,
                                                             std::uint32_t most_times);

}  // namespace sunder::validation
