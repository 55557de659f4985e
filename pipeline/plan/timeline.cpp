#include "pipeline/plan/timeline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sunder::plan {
namespace {

constexpr std::size_t kStepsOfCut = 48, kMostStepsBeside = 56;

/// Share of the cut in which the blade gains speed, and in which it loses it.
constexpr double kSpeedRamp = 0.15;

/// From 0 to 1 with two derivatives that are 0 at both ends.
double eased(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10 + x * (6 * x - 15));
}

/// The integral of eased() from 0 to x <= 1.
double eased_sum(double x) { return x * x * x * x * (2.5 + x * (x - 3)); }

/// Distances from the cut, ascending, up to `length`. The first one is about `step`.
std::vector<double> steps_away(double length, double step) {
  const double wanted = std::ceil(length / step);
  const auto count =
      static_cast<std::size_t>(std::clamp(wanted, 1.0, static_cast<double>(kMostStepsBeside)));
  const auto sum_of = [&](double growth) {  // of `count` steps, the first one being 1
    double sum = 0, next = 1;
    for (std::size_t i = 0; i < count; ++i, next *= growth) sum += next;
    return sum;
  };
  double growth = 1;
  if (wanted > static_cast<double>(kMostStepsBeside)) {
    double high = 2;
    while (sum_of(high) < length / step) high *= 2;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (growth + high);
      (sum_of(middle) < length / step ? growth : high) = middle;
    }
  }
  std::vector<double> away;
  double sum = 0, next = length / sum_of(growth);
  for (std::size_t i = 0; i < count; ++i, next *= growth) away.push_back(sum += next);
  away.back() = length;
  return away;
}

}  // namespace

double Timeline::share_at(double time) const {
  const double u = std::clamp((time - timing_.approach) / timing_.cut, 0.0, 1.0);
  const double speed = 1 / (1 - kSpeedRamp);
  if (u < kSpeedRamp) return speed * kSpeedRamp * eased_sum(u / kSpeedRamp);
  if (u > 1 - kSpeedRamp) return 1 - speed * kSpeedRamp * eased_sum((1 - u) / kSpeedRamp);
  return speed * (u - kSpeedRamp / 2);
}

double Timeline::even_speed() const { return 1 / ((1 - kSpeedRamp) * timing_.cut); }

double Timeline::lift_at(double time) const {
  if (time < cut_begins()) return 1 - eased(time / timing_.approach);
  if (time > cut_ends()) return eased((time - cut_ends()) / timing_.retreat);
  return 0;
}

std::vector<double> Timeline::knots() const {
  const double step = timing_.cut / static_cast<double>(kStepsOfCut);
  const std::vector<double> before = steps_away(timing_.approach, step);
  const std::vector<double> after = steps_away(timing_.retreat, step);
  std::vector<double> knots;
  for (std::size_t i = before.size(); i-- > 0;) knots.push_back(cut_begins() - before[i]);
  for (std::size_t i = 0; i < kStepsOfCut; ++i)
    knots.push_back(cut_begins() + step * static_cast<double>(i));
  knots.push_back(cut_ends());
  for (const double away : after) knots.push_back(cut_ends() + away);
  return knots;
}

}  // namespace sunder::plan
