#pragma once

#include <cmath>

namespace sunder::test {

/// The modified Bessel function K of a whole order, z > 0: the integral of exp(-z cosh t) cosh(n t)
/// over t > 0 by the trapezoidal rule, whose error is about the rounding for such integrands.
inline double bessel_k(int order, double z) {
  constexpr double kStep = 0.05;
  double sum = 0.5 * std::exp(-z);
  for (double t = kStep;; t += kStep) {
    const double part = std::exp(-z * std::cosh(t)) * std::cosh(order * t);
    sum += part;
    if (part < 1e-18 * sum) return kStep * sum;
  }
}

}  // namespace sunder::test
