#pragma once

#include <array>
#include <vector>

#include "bench/tear/tear_scene.h"

namespace sunder::bench {

/// Removals of surface and the plain tear of the same stroke at one size, measured in turns.
struct RemovalTimes {
  /// Median time by that of the plain tear.
  double width = 0, bore = 0, walled_bore = 0;
  /// Calls of operator new, the most of the width and the open bore.
  double allocations = 0, undo_allocations = 0;
};

/// About three seconds.
[[nodiscard]] RemovalTimes measure_removals(const Scene& scene);

/// `width_vs_tear`: time of a tear with a width, or of a bore without a wall whose rim crosses as
/// many faces, by that of the plain tear of the same stroke; the worst of both and of all sizes.
[[nodiscard]] double width_vs_tear();

}  // namespace sunder::bench
