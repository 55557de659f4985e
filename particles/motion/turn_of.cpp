#include "particles/motion/turn_of.h"

#include <cmath>

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
  x /= size;
  const auto cofactors = [](const Matrix& m) {
    Matrix c;
    c << m.col(1).cross(m.col(2)), m.col(2).cross(m.col(0)), m.col(0).cross(m.col(1));
    return c;
  };
  double change = 1;
  for (int i = 0; i < kMostIterations; ++i) {
    const Matrix c = cofactors(x);
    const double determinant = dot(x.col(0), c.col(0));
    if (!(determinant > kFlatDeterminant))
      return false;  // of a map of unit size; after the first round it is near 1
    const Matrix inverse_transposed = c / determinant;
    // Uniform scales vanish after one step, others soon; then scaling is not needed.
    const double scale =
        change > 1e-2 ? std::sqrt(std::sqrt(sum_of_squares(inverse_transposed) / sum_of_squares(x)))
                      : 1.0;
    const Matrix next = 0.5 * (scale * x + inverse_transposed / scale);
    change = sum_of_squares(next - x);
    x = next;
    if (change < kSquaredChange) break;
  }
  turn = x;
  return true;
}

}  // namespace sunder::particles
