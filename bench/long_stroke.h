#pragma once

namespace sunder::bench {

/// Microseconds a segment of one stroke of a thousand.
struct LongStroke {
  double first = 0;           ///< The one that enters.
  double second_to_21st = 0;  ///< Mean.
  double last_20 = 0;         ///< Mean.
};

/// A helix on a tube at rest, as many points as a scene of this size; each segment is as long as a
/// face is wide. What one costs should not depend on how many came before.
[[nodiscard]] LongStroke time_long_stroke(int divisions);

}  // namespace sunder::bench
