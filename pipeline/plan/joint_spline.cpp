#include "pipeline/plan/joint_spline.h"

#include <algorithm>

namespace sunder::plan {
namespace {

/// A knot, also one beyond an end: those go on as far apart as at the end.
double knot_at(std::span<const double> knots, std::ptrdiff_t i) {
  const auto last = static_cast<std::ptrdiff_t>(knots.size()) - 1;
  if (i < 0) return knots[0] + static_cast<double>(i) * (knots[1] - knots[0]);
  const auto end = static_cast<std::size_t>(last);
  if (i > last) return knots[end] + static_cast<double>(i - last) * (knots[end] - knots[end - 1]);
  return knots[static_cast<std::size_t>(i)];
}

}  // namespace

SplineWeights spline_weights(double time, std::span<const double> knots) {
  time = std::clamp(time, knots.front(), knots.back());
  const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, time) - knots.begin();
  const std::ptrdiff_t first = above - 1;
  SplineWeights of{static_cast<std::size_t>(first), {1, 0, 0, 0}};
  for (std::ptrdiff_t degree = 1; degree <= 3; ++degree) {
    double rest = 0;
    for (std::ptrdiff_t i = 0; i < degree; ++i) {
      const double right = knot_at(knots, first + i + 1);
      const double left = knot_at(knots, first + i + 1 - degree);
      double& weight = of.weights[static_cast<std::size_t>(i)];
      const double share = weight / (right - left);
      weight = rest + (right - time) * share;
      rest = (time - left) * share;
    }
    of.weights[static_cast<std::size_t>(degree)] = rest;
  }
  return of;
}

std::vector<double> derivative_weights(std::span<const double> knots, std::size_t order,
                                       std::size_t first) {
  std::vector<double> weights = {1};
  if (order == 0) return weights;
  const auto at = static_cast<std::ptrdiff_t>(first), of = static_cast<std::ptrdiff_t>(order);
  const double span = knot_at(knots, at + 1) - knot_at(knots, at - 3 + of);
  const double factor = static_cast<double>(4 - of) / span;
  weights.assign(order + 1, 0);
  const std::vector<double> here = derivative_weights(knots, order - 1, first);
  const std::vector<double> next = derivative_weights(knots, order - 1, first + 1);
  for (std::size_t i = 0; i < order; ++i) {
    weights[i] -= factor * here[i];
    weights[i + 1] += factor * next[i];
  }
  return weights;
}

Values JointSpline::at(double time) const {
  const SplineWeights of = spline_weights(time, knots);
  Values values = of.weights[0] * control[of.first];
  for (std::size_t i = 1; i < 4; ++i) values += of.weights[i] * control[of.first + i];
  return values;
}

}  // namespace sunder::plan
