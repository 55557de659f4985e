#include "particles/motion/damped_spring.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder {
namespace {

using particles::SpringStep;
using particles::step_spring;

struct State {
  double place, velocity;
};

State advance(const SpringStep& step, const State& from, double acceleration) {
  return {step.place_from_place * from.place + step.place_from_velocity * from.velocity +
              step.place_from_acceleration * acceleration,
          step.velocity_from_place * from.place + step.velocity_from_velocity * from.velocity +
              step.velocity_from_acceleration() * acceleration};
}

/// Runge-Kutta of fourth order, with steps that resolve all time constants.
State integrate(double stiffness, double ratio, double acceleration, State at, double seconds) {
  const double rate = 2 * ratio * std::sqrt(stiffness);
  const auto steps = static_cast<int>(std::ceil(seconds * (std::sqrt(stiffness) + rate + 1) * 200));
  const double h = seconds / steps;
  const auto change = [&](const State& s) {
    return State{s.velocity, acceleration - stiffness * s.place - rate * s.velocity};
  };
  const auto plus = [](const State& s, double t, const State& d) {
    return State{s.place + t * d.place, s.velocity + t * d.velocity};
  };
  for (int i = 0; i < steps; ++i) {
    const State a = change(at), b = change(plus(at, h / 2, a)), c = change(plus(at, h / 2, b)),
                d = change(plus(at, h, c));
    at = plus(plus(plus(plus(at, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
  }
  return at;
}

const std::vector<double> kRatios = {0.0, 0.05, 0.7, 1 - 1e-9, 1.0, 1 + 1e-9, 1 + 1e-5, 1.3, 20.0};

TEST(damped_spring, equals_a_fine_integration) {
  for (const double stiffness : {0.0, 1e-3, 1.0, 400.0, 9e3})
    for (const double ratio : kRatios)
      for (const double seconds : {1e-5, 1e-3, 1.0 / 60, 0.3, 1.0}) {
        const State start{0.7, -1.3};
        const State found = advance(step_spring(stiffness, ratio, seconds), start, 2.5);
        const State wanted = integrate(stiffness, ratio, 2.5, start, seconds);
        const double speed = 1.3 + 0.7 * std::sqrt(stiffness);
        EXPECT_NEAR(found.place, wanted.place, 1e-8) << stiffness << ' ' << ratio << ' ' << seconds;
        EXPECT_NEAR(found.velocity, wanted.velocity, 1e-8 * speed)
            << stiffness << ' ' << ratio << ' ' << seconds;
      }
}

TEST(damped_spring, does_not_depend_on_the_step) {
  for (const double stiffness : {0.5, 100.0, 1e6})
    for (const double ratio : kRatios) {
      const State start{1.0, 0.3 * std::sqrt(stiffness)};
      const State wanted = advance(step_spring(stiffness, ratio, 1.0), start, 0.2 * stiffness);
      for (const double seconds : {1e-5, 1e-4, 1e-3, 1e-2, 0.1}) {
        const SpringStep step = step_spring(stiffness, ratio, seconds);
        State at = start;
        for (int i = 0; i < static_cast<int>(std::lround(1 / seconds)); ++i)
          at = advance(step, at, 0.2 * stiffness);
        EXPECT_NEAR(at.place, wanted.place, 1e-6) << stiffness << ' ' << ratio << ' ' << seconds;
        EXPECT_NEAR(at.velocity, wanted.velocity, 1e-6 * std::sqrt(stiffness))
            << stiffness << ' ' << ratio << ' ' << seconds;
      }
    }
}

TEST(damped_spring, whole_periods_without_damping_can_be_divided_by) {
  constexpr double kTwoPi = 6.283185307179586;
  for (const double frequency : {1.0, 3.2, 60.0, 1.6e5})
    for (const double ratio : {0.0, 1e-300, 1e-18})
      for (const double periods : {1.0, 2.0, 16.0, 1000.0}) {
        const SpringStep step =
            step_spring(std::pow(kTwoPi * frequency, 2), ratio, periods / frequency);
        EXPECT_GT(step.place_from_acceleration, 0) << frequency << ' ' << ratio << ' ' << periods;
        EXPECT_TRUE(
            std::isfinite(step.velocity_from_acceleration() / step.place_from_acceleration));
      }
}

TEST(damped_spring, never_gains_energy) {
  test::Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double stiffness = std::pow(10.0, random.uniform(-6, 12)),
                 seconds = std::pow(10.0, random.uniform(-5, 0));
    const double ratio = i % 3 == 0   ? 1 + random.uniform(-1e-7, 1e-7)
                         : i % 3 == 1 ? random.uniform(0, 2)
                                      : std::pow(10.0, random.uniform(0, 6));
    const SpringStep step = step_spring(stiffness, ratio, seconds);
    const State start{random.uniform(-1, 1), random.uniform(-1, 1) * std::sqrt(stiffness)};
    const State end = advance(step, start, 0);
    const auto energy = [&](const State& s) {
      return stiffness * s.place * s.place + s.velocity * s.velocity;
    };
    ASSERT_LE(energy(end), energy(start) * (1 + 1e-9))
        << stiffness << ' ' << ratio << ' ' << seconds;
    ASSERT_GT(step.place_from_acceleration, 0);
    ASSERT_LE(step.place_from_acceleration, seconds * seconds / 2 * (1 + 1e-12))
        << stiffness << ' ' << ratio;
  }
}

TEST(damped_spring, response_to_a_force_keeps_its_digits) {
  // At the border between the power series and the closed form both must agree: g(2h) from g(h) by
  // the semigroup property.
  test::Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const double stiffness = std::pow(10.0, random.uniform(-6, 12)),
                 ratio = std::pow(10.0, random.uniform(-3, 4));
    const double seconds =
        0.25 * random.uniform(0.01, 4) / ((1 + 2 * ratio) * std::sqrt(stiffness));
    const SpringStep one = step_spring(stiffness, ratio, seconds),
                     two = step_spring(stiffness, ratio, 2 * seconds);
    const State end = advance(one, advance(one, {0, 0}, 1), 1);
    ASSERT_NEAR(end.place / two.place_from_acceleration, 1, 1e-11) << stiffness << ' ' << ratio;
  }
}

TEST(damped_spring, nothing_overflows) {
  for (const double stiffness : {0.0, 1e-300, 1e12})
    for (const double ratio : {0.0, 1.0, 1e6})
      for (const double seconds : {0.0, 1e-300, 1e-9, 1.0, 1e4}) {
        const State end = advance(step_spring(stiffness, ratio, seconds), {1, 1}, 1);
        EXPECT_TRUE(std::isfinite(end.place) && std::isfinite(end.velocity))
            << stiffness << ' ' << ratio << ' ' << seconds;
      }
  const SpringStep none = step_spring(100, 0.5, 0);
  EXPECT_EQ(none.place_from_place, 1);
  EXPECT_EQ(none.velocity_from_velocity, 1);
  EXPECT_EQ(none.place_from_acceleration, 0);
}

}  // namespace
}  // namespace sunder
