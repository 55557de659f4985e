#pragma once

namespace sunder::particles {

/// The response of a damped spring over a step, under a constant acceleration a, where x is the
/// place relative to the rest:
///
///   x(end) = place_from_place x + place_from_velocity v + place_from_acceleration a
///   v(end) = velocity_from_place x + velocity_from_velocity v + velocity_from_acceleration() a
struct SpringStep {
  double place_from_place = 1, place_from_velocity = 0;
  double place_from_acceleration = 0;  ///< > 0 after a step that takes time.
  double velocity_from_place = 0, velocity_from_velocity = 1;

  /// The response to a step is the integral of the response to an impulse.
  [[nodiscard]] double velocity_from_acceleration() const { return place_from_velocity; }
};

/// The exact solution of x'' = -stiffness x - 2 damping_ratio sqrt(stiffness) x' + a after
/// `seconds`, whatever the damping. Accurate near the critical ratio, and for steps that are tiny
/// or huge relative to the spring's period.
/// @param stiffness  1/s^2, in [0, 1e12]; @param damping_ratio  in [0, 1e6]; @param seconds  in [0,
/// 1e4]. Unchecked.
[[nodiscard]] SpringStep step_spring(double stiffness, double damping_ratio, double seconds);

}  // namespace sunder::particles
