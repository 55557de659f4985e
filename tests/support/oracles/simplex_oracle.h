#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace sunder::test {

struct SimplexOptimum {
  Eigen::VectorXd weights;
  double value = 0;
};

/// The minimum of w^T G w - 2 c^T w over weights >= 0 with sum 1 and at most `maximum` non-zero
/// entries, by trying every support.
SimplexOptimum best_on_simplex(const Eigen::MatrixXd& gram, const Eigen::VectorXd& linear,
                               std::size_t maximum);

}  // namespace sunder::test
