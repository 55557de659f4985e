#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "pipeline/plan/blade_chain.h"

namespace sunder::plan {

/// Uniform cubic B-splines of all values over time: two derivatives are continuous. The greatest
/// difference of neighbouring control points bounds speeds, that of second differences the
/// accelerations, and the control points bound the values (de Boor 1978).
struct JointSpline {
  double duration = 1;          ///< Seconds; > 0.
  std::vector<Values> control;  ///< At least four.

  [[nodiscard]] std::size_t intervals() const { return control.size() - 3; }
  [[nodiscard]] double step() const { return duration / static_cast<double>(intervals()); }
  [[nodiscard]] Values at(double time) const;
};

/// The four control points that count at a time, and their weights.
struct SplineWeights {
  std::size_t first = 0;
  std::array<double, 4> weights = {};
};
[[nodiscard]] SplineWeights spline_weights(double time, double duration, std::size_t intervals);

}  // namespace sunder::plan
