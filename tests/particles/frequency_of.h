#pragma once

#include <cmath>
#include <numbers>

namespace sunder::test {

/// Hertz, of a spring with a stiffness by mass, 1/s^2.
inline double frequency_of(double stiffness) {
  return std::sqrt(stiffness) / (2 * std::numbers::pi);
}

}  // namespace sunder::test
