#include "support/oracles/simplex_oracle.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/LU>

namespace sunder::test {

SimplexOptimum best_on_simplex(const Eigen::MatrixXd& gram, const Eigen::VectorXd& linear,
                               std::size_t maximum) {
  SimplexOptimum best;
  best.value = std::numeric_limits<double>::infinity();
  const auto n = static_cast<int>(linear.size());
  const double scale = gram.diagonal().maxCoeff() + 1e-300;
  for (std::uint32_t support = 1; support < 1u << n; ++support) {
    if (static_cast<std::size_t>(std::popcount(support)) > maximum) continue;
    std::vector<int> slots;
    for (int i = 0; i < n; ++i)
      if ((support >> i & 1u) != 0) slots.push_back(i);
    // [G 1; 1^T 0] [w; multiplier] = [c; 1], in units of G.
    const auto m = static_cast<Eigen::Index>(slots.size());
    Eigen::MatrixXd left = Eigen::MatrixXd::Ones(m + 1, m + 1);
    Eigen::VectorXd right = Eigen::VectorXd::Ones(m + 1);
    left(m, m) = 0;
    left.topLeftCorner(m, m) = gram(slots, slots) / scale;
    right.head(m) = linear(slots) / scale;
    const Eigen::VectorXd solution = left.fullPivLu().solve(right);
    if (!solution.allFinite() || !(solution.head(m).minCoeff() >= 0) ||
        std::abs(solution.head(m).sum() - 1) > 1e-9)
      continue;
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(n);
    weights(slots) = solution.head(m) / solution.head(m).sum();
    const double value = weights.dot(gram * weights - 2 * linear);
    if (value < best.value) best = {weights, value};
  }
  return best;
}

}  // namespace sunder::test
