#include "particles/motion/turn_of.h"

#include <cmath>
#include <numbers>

#include "core/internal/ordered.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {

namespace {

/// Norms whose cubes neither underflow nor overflow.
constexpr double kLeastNorm = 1e-150, kMostNorm = 1e150;
/// If the squared change of the iterate is below this, the iteration ends: the next change is below
/// rounding, because convergence is quadratic.
constexpr double kSquaredChange = 1e-15;
constexpr int kMostIterations = 40;
/// Iterates whose determinant is nearer to 1 are not scaled. Their singular values are near 1: the
/// sum of their squares is 3 in the first round, and they are at least 1 in all later ones.
constexpr double kFarDeterminant = 0.1;

/// Sum over the columns of their squared norms: one written order, and three short sums that do not
/// wait for each other.
double sum_of_squares(const Eigen::Matrix3d& m) {
  return squared_norm(m.col(0)) + squared_norm(m.col(1)) + squared_norm(m.col(2));
}

}  // namespace

bool turn_of(const Mat3d& linear, Mat3d& turn) {
  using Matrix = Eigen::Matrix3d;
  Matrix x = linear;
  const double size = std::sqrt(sum_of_squares(x));
  if (!(size > kLeastNorm) || !(size < kMostNorm)) return false;
  x *= std::numbers::sqrt3 / size;  // the norm of a rotation
  for (int i = 0; i < kMostIterations; ++i) {
    Matrix cofactors;
    cofactors << x.col(1).cross(x.col(2)), x.col(2).cross(x.col(0)), x.col(0).cross(x.col(1));
    const double determinant = dot(x.col(0), cofactors.col(0));
    if (i == 0 && !(determinant > kFlatDeterminant * 3 * std::numbers::sqrt3)) return false;
    double by_x = 0.5, by_cofactors = 0.5 / determinant;
    if (std::abs(determinant - 1) > kFarDeterminant) {
      const double scale =
          std::sqrt(std::sqrt(sum_of_squares(cofactors) / sum_of_squares(x)) / determinant);
      by_x *= scale;
      by_cofactors /= scale;
    }
    const Matrix next = by_x * x + by_cofactors * cofactors;
    const double change = sum_of_squares(next - x);
    x = next;
    if (change < kSquaredChange) break;
  }
  turn = x;
  return true;
}

}  // namespace sunder::particles
