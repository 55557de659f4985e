#include "pipeline/plan/stroke_pace.h"

#include <algorithm>
#include <cmath>

namespace sunder::plan {
namespace {

/// What is judged: the blade gains speed before, and loses it afterwards.
constexpr double kEvenBegin = 0.1, kEvenEnd = 0.9;
constexpr std::size_t kEvenParts = 16;  ///< Of that, whose times are compared.
constexpr double kJerkStep = 0.02;      ///< Seconds between the places whose differences are taken,
constexpr double kLeastSteps = 24;      ///< or so many, but not
constexpr double kOfRecording = 2;      ///< less than so many times what is between blades,
constexpr double kFewestSteps = 8;      ///< and not fewer.
constexpr int kAveragedOfStep = 8;      ///< Places of a step that are averaged.
/// Of a straight reach of least jerk (Flash and Hogan 1985): 720 D^2 / T^5 for a distance D, whose
/// greatest speed is 1.875 D / T.
constexpr double kReachJerk = 720 / (1.875 * 1.875);
constexpr double kLeastJerk = 1e-6;

/// Linear between entries; held at both ends.
template <typename Number>
Number between(std::span<const double> at, std::span<const Number> numbers, double where) {
  const auto next =
      static_cast<std::size_t>(std::lower_bound(at.begin(), at.end(), where) - at.begin());
  if (next == 0) return numbers.front();
  if (next == at.size()) return numbers.back();
  const double part = (where - at[next - 1]) / (at[next] - at[next - 1]);
  return (1 - part) * numbers[next - 1] + part * numbers[next];
}

/// Places at even times from `begin` to `end`, each averaged over a step.
std::vector<Vec3d> resampled(std::span<const double> times, std::span<const Vec3d> places,
                             double begin, double end, std::size_t steps) {
  const double step = (end - begin) / static_cast<double>(steps);
  std::vector<Vec3d> even(steps + 1, Vec3d::Zero());
  for (std::size_t i = 0; i <= steps; ++i)
    for (int k = 0; k < kAveragedOfStep; ++k) {
      const double part = (k + 0.5) / kAveragedOfStep - 0.5;
      const double time = begin + (static_cast<double>(i) + part) * step;
      even[i] += between<Vec3d>(times, places, time) / kAveragedOfStep;
    }
  return even;
}

/// T^3 / v^2 times the integral of the squared jerk, v being the greatest speed.
double dimensionless_jerk(const std::vector<Vec3d>& places, double seconds) {
  const double step = seconds / static_cast<double>(places.size() - 1);
  double sum = 0, fastest = 0;
  for (std::size_t i = 1; i < places.size(); ++i)
    fastest = std::max(fastest, (places[i] - places[i - 1]).norm() / step);
  for (std::size_t i = 3; i < places.size(); ++i) {
    const Vec3d third = places[i] - 3 * places[i - 1] + 3 * places[i - 2] - places[i - 3];
    sum += third.squaredNorm() / (step * step * step * step * step);
  }
  return fastest > 0 ? seconds * seconds * seconds / (fastest * fastest) * sum : 0;
}

/// The even part of a stroke: when it begins and ends, and the times at its kEvenParts + 1 borders.
struct EvenPart {
  double length = 0;  ///< Share of the curve.
  std::vector<double> borders;
};

EvenPart even_part(std::span<const PacedBlade> blades) {
  const double first = blades.front().share, whole = blades.back().share - first;
  EvenPart part{(kEvenEnd - kEvenBegin) * whole, {}};
  std::size_t next = 0;
  for (std::size_t i = 0; i <= kEvenParts; ++i) {
    const double share = first + whole * (kEvenBegin + (kEvenEnd - kEvenBegin) *
                                                           static_cast<double>(i) / kEvenParts);
    while (next + 1 < blades.size() && blades[next].share < share) ++next;
    double time = blades[next].time;
    if (next > 0 && blades[next].share > share) {
      const PacedBlade& before = blades[next - 1];
      const double of = (share - before.share) / (blades[next].share - before.share);
      time = before.time + of * (time - before.time);
    }
    part.borders.push_back(time);
  }
  return part;
}

/// Standard deviation of the times that equal parts take, over their mean.
double unevenness_of(const std::vector<double>& borders) {
  const double mean = (borders.back() - borders.front()) / kEvenParts;
  double sum = 0;
  for (std::size_t i = 1; i <= kEvenParts; ++i) {
    const double off = borders[i] - borders[i - 1] - mean;
    sum += off * off;
  }
  return std::sqrt(sum / kEvenParts) / mean;
}

}  // namespace

StrokePace pace_of(std::span<const PacedBlade> blades, std::span<const Vec3d> places,
                   std::span<const double> times, double length, double wanted_speed) {
  StrokePace pace;
  pace.seconds = blades.back().time - blades.front().time;
  pace.wanted_speed = wanted_speed;
  pace.unevenness = 1;
  const EvenPart part = even_part(blades);
  const double begin = part.borders.front(), end = part.borders.back(), seconds = end - begin;
  if (!(part.length > 0) || !(seconds > 0)) return pace;
  pace.speed = part.length * length / seconds;
  pace.unevenness = unevenness_of(part.borders);

  const auto recorded = std::count_if(times.begin(), times.end(),
                                      [&](double time) { return time >= begin && time <= end; });
  const double most = static_cast<double>(recorded) / kOfRecording;
  const double steps = std::floor(std::min(std::max(seconds / kJerkStep, kLeastSteps), most));
  if (steps < kFewestSteps) return pace;
  const auto count = static_cast<std::size_t>(steps);
  std::vector<Vec3d> ideals;
  std::vector<double> blade_times;
  for (const PacedBlade& blade : blades) {
    ideals.push_back(blade.ideal);
    blade_times.push_back(blade.time);
  }
  const double performed = dimensionless_jerk(resampled(times, places, begin, end, count), seconds);
  const double ideal =
      dimensionless_jerk(resampled(blade_times, ideals, begin, end, count), seconds);
  pace.log_jerk = -std::log(std::max(performed, kLeastJerk));
  pace.wanted_log_jerk = -std::log(std::max(ideal, kReachJerk));
  return pace;
}

}  // namespace sunder::plan
