#pragma once

#include <numbers>

namespace sunder::particles {

/// Radians per second, of a frequency in hertz.
constexpr double angular_frequency(double hertz) { return 2 * std::numbers::pi * hertz; }

/// The stiffness by mass, 1/s^2, of a spring that swings with a frequency in hertz.
constexpr double squared_frequency(double hertz) {
  return angular_frequency(hertz) * angular_frequency(hertz);
}

}  // namespace sunder::particles
