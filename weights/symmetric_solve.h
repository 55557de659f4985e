#pragma once

#include <sunder/core/math.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace sunder::weights {

/// Solves A x = b for a symmetric, positive semidefinite 3 x 3 matrix by pivoted L D L^T, in a
/// written order. A direction in which A is zero gets 0.
inline Vec3d solve_symmetric(Mat3d a, const Vec3d& b) {
  std::array<int, 3> order = {0, 1, 2};
  const auto at = [&](int row, int column) -> double& {
    return a.coeffRef(order[static_cast<std::size_t>(row)],
                      order[static_cast<std::size_t>(column)]);
  };
  for (int k = 0; k < 3; ++k) {
    int pivot = k;
    for (int i = k + 1; i < 3; ++i)
      if (std::abs(at(i, i)) > std::abs(at(pivot, pivot))) pivot = i;
    std::swap(order[static_cast<std::size_t>(k)], order[static_cast<std::size_t>(pivot)]);
    if (!(std::abs(at(k, k)) > std::numeric_limits<double>::min())) break;  // the rest is zero
    for (int i = k + 1; i < 3; ++i) at(i, k) /= at(k, k);
    for (int i = k + 1; i < 3; ++i)
      for (int j = k + 1; j < 3; ++j) at(i, j) -= at(i, k) * at(k, k) * at(j, k);
  }
  Vec3d x = Vec3d::Zero();
  const auto x_at = [&](int i) -> double& { return x[order[static_cast<std::size_t>(i)]]; };
  for (int i = 0; i < 3; ++i) {
    x_at(i) = b[order[static_cast<std::size_t>(i)]];
    for (int k = 0; k < i; ++k) x_at(i) -= at(i, k) * x_at(k);
  }
  for (int i = 0; i < 3; ++i)
    x_at(i) = std::abs(at(i, i)) > std::numeric_limits<double>::min() ? x_at(i) / at(i, i) : 0.0;
  for (int i = 2; i >= 0; --i)
    for (int k = i + 1; k < 3; ++k) x_at(i) -= at(k, i) * x_at(k);
  return x;
}

}  // namespace sunder::weights
