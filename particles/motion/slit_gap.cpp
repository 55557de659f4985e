#include "particles/motion/slit_gap.h"

#include <cmath>
#include <numbers>

namespace sunder::particles {

double slit_gap(double half_length) {
  // Beyond this length the tips are not felt in the middle: the ratio rounds to 1.
  constexpr double kLong = 50;
  if (!(half_length < kLong)) return 1;
  // An ellipse for short slits: erf(y) = 2 y / sqrt(pi) = half_length. At a distance s from the tip
  // of a long slit the gap is erf(sqrt(s)), so y approaches the root of the length. Between the two
  // the coefficients are fitted to the solution of the integral equation.
  constexpr double kShort = std::numbers::pi / 4, kAbove = 1.436, kBelow = 1.499;
  const double a = half_length;
  const double squared =
      kShort * a * a * (1 + kAbove * a) / (1 + kBelow * a + kShort * kAbove * a * a);
  return std::erf(std::sqrt(squared));
}

}  // namespace sunder::particles
