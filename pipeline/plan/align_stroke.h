#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace sunder::plan {

/// Which place of a curve each blade of a stroke is at.
struct AlignedStroke {
  /// Per blade, not descending: the step of the curve from its begin, or from its end where the
  /// stroke is backwards. On a closed curve, up to two rounds.
  std::vector<std::size_t> steps;
  bool is_backwards = false;
};

/// Aligns a stroke with a curve: the blades go along it in one direction, and the sum of squared
/// distances is the least one (dynamic time warping with free ends, Sakoe and Chiba 1978).
/// @param squares  per blade the squared distances from `steps` even places of the curve, from its
///                 begin to its end; of a closed curve the last one is the first one.
[[nodiscard]] AlignedStroke align_stroke(std::span<const float> squares, std::size_t steps,
                                         bool is_closed);

}  // namespace sunder::plan
