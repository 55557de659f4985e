#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace sunder::weights {

/// Finds the least of w^T G w - 2 c^T w over weights w >= 0 with sum 1. Keeps its memory from one
/// problem to the next.
class SimplexSolver {
 public:
  /// Begins a problem of so many weights, to be filled in.
  void resize(std::size_t count);
  [[nodiscard]] std::size_t count() const { return linear_.size(); }
  [[nodiscard]] double& gram(std::size_t i, std::size_t j) {
    return gram_[i * count() + j];
  }  ///< G: symmetric, positive definite.
  [[nodiscard]] double& linear(std::size_t i) { return linear_[i]; }  ///< c.

  [[nodiscard]] double value(std::span<const double> weights) const;

  /// Solves exactly, by an active set: a step to the optimum of the weights that are not zero, or
  /// as far as the first of them that becomes zero; at the optimum the weight is freed whose growth
  /// gains most, until none gains. Each step lowers the value, so that the result is never worse
  /// than where it began, and the steps come to an end. Source: Nocedal, Wright, Numerical
  /// Optimization, 2006, algorithm 16.3 [nocedal2006numerical].
  ///
  /// @param weights  in: where to begin, >= 0, sum 1. Out: the optimum.
  /// @param allowed  which of them may become more than zero.
  void solve(std::span<double> weights, const std::vector<bool>& allowed);

 private:
  [[nodiscard]] double at(std::size_t i, std::size_t j) const { return gram_[i * count() + j]; }
  [[nodiscard]] bool solve_free(double& multiplier);

  std::vector<double> gram_, linear_;
  std::vector<std::size_t> free_;  ///< The weights that are not zero.
  std::vector<double> factor_, solution_, of_ones_;
};

}  // namespace sunder::weights
