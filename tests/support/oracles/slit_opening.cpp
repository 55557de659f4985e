#include "support/oracles/slit_opening.h"

#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "support/oracles/bessel.h"

namespace sunder::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// The integral of -ln|cos s - cos t| cos(j s) cos(k t) over s and t from 0 to pi.
double log_moment(int j, int k) {
  if (j != k) return 0;
  return j == 0 ? kPi * kPi * std::log(2.0) : kPi * kPi / (2.0 * j);
}

}  // namespace

double slit_opening(double half_length) {
  // The gap w(x) of a slit |x| < 1, in units of its half length, satisfies for all v that vanish
  // at the tips (Hadamard's integral, by parts)
  //
  //   int int (w' v' + a^2 w v) K0(a |x - t|) dx dt = 2 pi int v dx
  //
  // under a unit tension. With x = cos s, w is a series of sines of odd multiples of s. K0 is split
  // into -ln|x - t|, whose moments are known, and a rest that sums over middles integrate well.
  constexpr int kTerms = 24, kPlaces = 320;
  const double a = half_length, step = kPi / kPlaces;
  Eigen::MatrixXd slopes(kTerms, kPlaces), values(kTerms, kPlaces), rest(kPlaces, kPlaces);
  for (int i = 0; i < kPlaces; ++i) {
    const double s = (i + 0.5) * step;
    for (int k = 0; k < kTerms; ++k) {
      const int m = 2 * k + 1;
      slopes(k, i) = m * std::cos(m * s);
      values(k, i) = a * std::sin(m * s) * std::sin(s);
    }
    rest(i, i) = -std::log(a / 2) - std::numbers::egamma;
    for (int j = 0; j < i; ++j) {
      const double apart = std::abs(std::cos(s) - std::cos((j + 0.5) * step));
      rest(i, j) = rest(j, i) = bessel_k(0, a * apart) + std::log(apart);
    }
  }
  Eigen::MatrixXd matrix =
      step * step * (slopes * rest * slopes.transpose() + values * rest * values.transpose());
  for (int p = 0; p < kTerms; ++p)
    for (int q = 0; q < kTerms; ++q) {
      const int m = 2 * p + 1, n = 2 * q + 1;
      matrix(p, q) +=
          m * n * log_moment(m, n) + a * a / 4 *
                                         (log_moment(m - 1, n - 1) - log_moment(m - 1, n + 1) -
                                          log_moment(m + 1, n - 1) + log_moment(m + 1, n + 1));
    }
  Eigen::VectorXd loads = Eigen::VectorXd::Zero(kTerms);
  loads[0] = kPi * kPi;
  const Eigen::VectorXd found = matrix.ldlt().solve(loads);
  double width = 0;
  for (int k = 0; k < kTerms; ++k) width += (k % 2 == 0 ? 1 : -1) * found[k];
  return width / 2;
}

}  // namespace sunder::test
