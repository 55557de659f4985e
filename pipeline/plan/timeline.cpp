#include "pipeline/plan/timeline.h"

#include <algorithm>

namespace sunder::plan {
namespace {

/// Share of the cut in which the blade gains speed, and in which it loses it.
constexpr double kSpeedRamp = 0.15;

/// From 0 to 1 with two derivatives that are 0 at both ends.
double eased(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10 + x * (6 * x - 15));
}

/// The integral of eased() from 0 to x <= 1.
double eased_sum(double x) { return x * x * x * x * (2.5 + x * (x - 3)); }

}  // namespace

double Timeline::share_at(double time) const {
  const double u = std::clamp((time - timing_.approach) / timing_.cut, 0.0, 1.0);
  const double speed = 1 / (1 - kSpeedRamp);
  if (u < kSpeedRamp) return speed * kSpeedRamp * eased_sum(u / kSpeedRamp);
  if (u > 1 - kSpeedRamp) return 1 - speed * kSpeedRamp * eased_sum((1 - u) / kSpeedRamp);
  return speed * (u - kSpeedRamp / 2);
}

double Timeline::lift_at(double time) const {
  if (time < cut_begins()) return 1 - eased(time / timing_.approach);
  if (time > cut_ends()) return eased((time - cut_ends()) / timing_.retreat);
  return 0;
}

}  // namespace sunder::plan
