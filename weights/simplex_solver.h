#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace sunder::weights {

/// Minimises w^T G w - 2 c^T w over weights w >= 0 with sum 1. Reuses its memory from one problem
/// to the next.
class SimplexSolver {
 public:
  /// Begins a problem of `count` weights; the caller then fills in gram() and linear().
  void resize(std::size_t count);
  [[nodiscard]] std::size_t count() const { return linear_.size(); }
  [[nodiscard]] double& gram(std::size_t i, std::size_t j) {
    return gram_[i * count() + j];
  }  ///< G: symmetric, positive definite.
  [[nodiscard]] double& linear(std::size_t i) { return linear_[i]; }  ///< c.

  /// The value of the objective at `weights`.
  [[nodiscard]] double value(std::span<const double> weights) const;

  /// Solves exactly by an active set. Each step moves to the optimum over the non-zero weights, or
  /// stops where the first of them becomes zero; at an optimum the weight whose growth gains most
  /// is freed, until none gains. Each step lowers the value, so the result is never worse than the
  /// start and the iteration ends. Source: Nocedal, Wright, Numerical Optimization, 2006, algorithm
  /// 16.3 [nocedal2006numerical].
  ///
  /// @param weights  in: the start, >= 0, sum 1. Out: the optimum.
  /// @param allowed  which weights may become positive.
  void solve(std::span<double> weights, const std::vector<bool>& allowed);

 private:
  [[nodiscard]] double at(std::size_t i, std::size_t j) const { return gram_[i * count() + j]; }
  [[nodiscard]] bool solve_free(double& multiplier);

  std::vector<double> gram_, linear_;
  std::vector<std::size_t> free_;  ///< The indices of the non-zero weights.
  std::vector<double> factor_, solution_, of_ones_;
};

}  // namespace sunder::weights
