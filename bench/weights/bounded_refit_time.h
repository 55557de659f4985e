#pragma once

#include "bench/weights/weights_scene.h"

namespace sunder::bench {

/// The time of fits within bounds over groups of poses, with K = 4: the rest pose, each clip, the
/// range of motion.
struct BoundedRefitTime {
  std::size_t points = 0, groups = 0;
  double bounded = 0;  ///< Microseconds per point.
  /// The same without bounds, over all poses as one group, as fits were made before there were
  /// groups.
  double plain = 0;
};

/// Weights alone, because the bind positions of points that are exact at rest stay.
[[nodiscard]] BoundedRefitTime measure_bounded_refit(const WeightsModel& model);

}  // namespace sunder::bench
