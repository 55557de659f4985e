#include "weights/simplex_solver.h"

#include <algorithm>
#include <cmath>

namespace sunder::weights {

void SimplexSolver::resize(std::size_t count) {
  gram_.resize(count * count);
  linear_.resize(count);
  factor_.resize(count * count);
  solution_.resize(count);
  of_ones_.resize(count);
  free_.reserve(count);
}

double SimplexSolver::value(std::span<const double> weights) const {
  double sum = 0;
  for (std::size_t i = 0; i < count(); ++i) {
    double row = -2 * linear_[i];
    for (std::size_t j = 0; j < count(); ++j) row += at(i, j) * weights[j];
    sum += weights[i] * row;
  }
  return sum;
}

/// Computes the optimum over the free weights alone, with sum one, by a Cholesky factorisation of
/// G: the solution of [G 1; 1^T 0].
/// @return false if G is not positive definite.
bool SimplexSolver::solve_free(double& multiplier) {
  const std::size_t n = free_.size();
  double* const factor = factor_.data();
  double* const of_linear = solution_.data();
  double* const of_ones = of_ones_.data();
  for (std::size_t i = 0; i < n; ++i) {
    double by_linear = linear_[free_[i]], by_ones = 1;
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = at(free_[i], free_[j]);
      for (std::size_t k = 0; k < j; ++k) sum -= factor[i * n + k] * factor[j * n + k];
      if (j < i) {
        factor[i * n + j] = sum * factor[j * n + j];
        by_linear -= factor[i * n + j] * of_linear[j];
        by_ones -= factor[i * n + j] * of_ones[j];
      } else {
        if (!(sum > 0)) return false;
        factor[i * n + i] = 1 / std::sqrt(sum);  // to multiply by
      }
    }
    of_linear[i] = by_linear * factor[i * n + i];
    of_ones[i] = by_ones * factor[i * n + i];
  }
  double linear_sum = 0, ones_sum = 0;
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) {
      of_linear[i] -= factor[k * n + i] * of_linear[k];
      of_ones[i] -= factor[k * n + i] * of_ones[k];
    }
    of_linear[i] *= factor[i * n + i];
    of_ones[i] *= factor[i * n + i];
    linear_sum += of_linear[i];
    ones_sum += of_ones[i];
  }
  multiplier = (linear_sum - 1) / ones_sum;
  for (std::size_t i = 0; i < n; ++i) of_linear[i] -= multiplier * of_ones[i];
  return std::isfinite(multiplier);
}

void SimplexSolver::solve(std::span<double> weights, const std::vector<bool>& allowed) {
  free_.clear();
  double largest = 0;
  for (std::size_t i = 0; i < count(); ++i) {
    if (weights[i] > 0) free_.push_back(i);
    largest = std::max(largest, std::abs(at(i, i)));
  }
  // Each round frees or fixes one weight, so a few suffice. The limit guards against rounding.
  for (std::size_t round = 0; round < 8 * count(); ++round) {
    double multiplier = 0;
    if (free_.empty() || !solve_free(multiplier)) return;
    double step = 1;
    for (std::size_t i = 0; i < free_.size(); ++i)
      if (!(solution_[i] > 0))
        step = std::min(step, weights[free_[i]] / (weights[free_[i]] - solution_[i]));
    const bool is_optimum = std::all_of(
        solution_.begin(), solution_.begin() + static_cast<std::ptrdiff_t>(free_.size()),
        [](double weight) { return weight > 0; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      double& weight = weights[free_[i]];
      // The weight that stops the step becomes zero, whatever rounding leaves of it.
      const bool is_stop = !(solution_[i] > 0) && weight / (weight - solution_[i]) <= step;
      weight = is_optimum ? solution_[i] : is_stop ? 0.0 : weight + step * (solution_[i] - weight);
      if (weight > 0)
        free_[kept++] = free_[i];
      else
        weight = 0;
    }
    free_.resize(kept);
    if (!is_optimum) continue;
    // For the free weights (G w - c)_i = -multiplier; a weight whose value is lower gains by
    // growing.
    std::size_t best = count();
    double least = -1e-12 * largest;
    for (std::size_t i = 0; i < count(); ++i) {
      if (!allowed[i] || weights[i] > 0) continue;
      double slope = multiplier - linear_[i];
      for (const std::size_t j : free_) slope += at(i, j) * weights[j];
      if (slope < least) {
        least = slope;
        best = i;
      }
    }
    if (best == count()) return;
    free_.push_back(best);
  }
}

}  // namespace sunder::weights
