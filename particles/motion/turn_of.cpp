#include "particles/motion/turn_of.h"

#include <cmath>

namespace sunder::particles {

bool turn_of(const Mat3d& linear, Mat3d& turn) {
  using Matrix = Eigen::Matrix3d;
  Matrix x = linear;
  const double size = x.norm();
  if (!(size > 1e-150) || !(size < 1e150)) return false;
  x /= size;
  const auto cofactors = [](const Matrix& m) {
    Matrix c;
    c << m.col(1).cross(m.col(2)), m.col(2).cross(m.col(0)), m.col(0).cross(m.col(1));
    return c;
  };
  double change = 1;
  for (int i = 0; i < 40; ++i) {
    const Matrix c = cofactors(x);
    const double determinant = x.col(0).dot(c.col(0));
    if (!(determinant > 1e-9)) return false;  // of a map of unit size; after the first round it is near 1
    const Matrix inverse_transposed = c / determinant;
    // Scales alike in all directions are gone after one step, others soon; then nothing is left to scale.
    const double scale = change > 1e-2 ? std::sqrt(inverse_transposed.norm() / x.norm()) : 1.0;
    const Matrix next = 0.5 * (scale * x + inverse_transposed / scale);
    change = (next - x).squaredNorm();
    x = next;
    if (change < 1e-15) break;  // it converges quadratically: the next one is below rounding
  }
  turn = x;
  return true;
}

}  // namespace sunder::particles
