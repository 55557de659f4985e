#pragma once

namespace sunder::bench {

/// Microseconds per segment of one stroke with a thousand segments.
struct LongStroke {
  double first = 0;           ///< The segment that enters the surface.
  double second_to_21st = 0;  ///< Mean.
  double last_20 = 0;         ///< Mean.
};

/// The stroke is a helix on a tube at rest with as many points as a scene of this size; each
/// segment is as long as a face is wide. The cost of a segment should not depend on the number of
/// segments before it.
[[nodiscard]] LongStroke time_long_stroke(int divisions);

}  // namespace sunder::bench
