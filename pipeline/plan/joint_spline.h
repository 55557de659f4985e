#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "pipeline/plan/blade_chain.h"

namespace sunder::plan {

/// Cubic B-splines of all values over time: two derivatives are continuous, knots may be uneven.
/// The control points bound the values, and the control points of the derivatives bound speeds and
/// accelerations (de Boor 1978).
struct JointSpline {
  std::vector<double> knots;    ///< Seconds, ascending: at least two, the first one 0.
  std::vector<Values> control;  ///< Two more than knots.

  [[nodiscard]] double duration() const { return knots.back(); }
  [[nodiscard]] std::size_t intervals() const { return knots.size() - 1; }
  [[nodiscard]] Values at(double time) const;
};

/// The four control points that count at a time, and their weights.
struct SplineWeights {
  std::size_t first = 0;
  std::array<double, 4> weights = {};
};
[[nodiscard]] SplineWeights spline_weights(double time, std::span<const double> knots);

/// Weights of the control points `first` to `first` + `order` in the control point `first` of a
/// derivative. Those of the second derivative are its values at the knots, those of the third one
/// its values between them.
/// @param order  of the derivative, 0 to 3.
[[nodiscard]] std::vector<double> derivative_weights(std::span<const double> knots,
                                                     std::size_t order, std::size_t first);

}  // namespace sunder::plan
