#include "particles/motion/damped_spring.h"

#include <algorithm>
#include <cmath>

#include "core/internal/elementary.h"

namespace sunder::particles {
namespace {

/// (1 - e^-x) / x.
double mean_decay(double x) { return x > 0 ? -elementary::expm1(-x) / x : 1.0; }

/// After whole periods without damping, a constant acceleration has moved the place by nothing. The
/// difference of rounded numbers is 0 then, by which nobody can divide; the exact one is about the
/// square of the rounding error.
constexpr double kLeastResponse = 1e-32;

/// The response to a unit acceleration by its power series, for steps much shorter than all times
/// of the spring: 1 - place_from_place has few digits there. Terms t_n of g(h) = sum t_n follow
/// from g'' + 2 l g' + k g = 1.
double short_response(double stiffness, double twice_rate, double seconds) {
  const double z = stiffness * seconds * seconds, b = twice_rate * seconds;
  double before = 0.0, term = 0.5, sum = 0.5;
  for (int n = 1; n < 24; ++n) {
    const double next = -b * term / (n + 2) - z * before / ((n + 2.0) * (n + 1.0));
    before = term;
    term = next;
    sum += next;
  }
  return sum * seconds * seconds;
}

}  // namespace

SpringStep step_spring(double stiffness, double damping_ratio, double seconds) {
  SpringStep step;
  const double frequency = std::sqrt(stiffness), rate = damping_ratio * frequency;
  const bool is_short = (2 * rate + frequency) * seconds < 0.5;
  if (damping_ratio < 1) {
    const double turn = frequency * std::sqrt((1 - damping_ratio) * (1 + damping_ratio)) * seconds;
    const double decay = elementary::exp(-rate * seconds), cosine = decay * elementary::cos(turn);
    step.place_from_velocity = decay * seconds * (turn > 0 ? elementary::sin(turn) / turn : 1.0);
    step.place_from_place = cosine + rate * step.place_from_velocity;
    step.velocity_from_velocity = cosine - rate * step.place_from_velocity;
    step.place_from_acceleration =
        is_short ? short_response(stiffness, 2 * rate, seconds)
                 : std::max(1 - step.place_from_place, kLeastResponse) / stiffness;
  } else {
    // Two decays. The slow one is computed from the product of both, because their difference loses
    // all digits if the fast one is very fast.
    const double apart = frequency * std::sqrt((damping_ratio - 1) * (damping_ratio + 1));
    const double fast = rate + apart, slow = fast > 0 ? stiffness / fast : 0.0;
    const double slow_decay = elementary::exp(-slow * seconds),
                 fast_decay = elementary::exp(-fast * seconds);
    step.place_from_velocity = slow_decay * seconds * mean_decay(2 * apart * seconds);
    step.place_from_place = slow_decay + slow * step.place_from_velocity;
    step.velocity_from_velocity = fast_decay - slow * step.place_from_velocity;
    step.place_from_acceleration =
        is_short ? short_response(stiffness, 2 * rate, seconds)
                 : (seconds * mean_decay(slow * seconds) - step.place_from_velocity) / fast;
  }
  step.velocity_from_place = -stiffness * step.place_from_velocity;
  return step;
}

}  // namespace sunder::particles
