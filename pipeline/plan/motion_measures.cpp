#include "pipeline/plan/motion_measures.h"

#include <algorithm>
#include <cmath>

#include "pipeline/plan/blade_errors.h"

namespace sunder::plan {
namespace {

constexpr double kRate = 240;        ///< Samples of the trajectory per second, or
constexpr double kLeastOfCut = 240;  ///< in the cut, if it takes less.

/// Even times in each of approach, cut and retreat.
std::vector<double> trajectory_times(const Timeline& timeline) {
  std::vector<double> times = {0};
  const auto add = [&](double begin, double end, double least) {
    const double steps = std::max(std::ceil((end - begin) * kRate), least);
    for (double k = 1; k <= steps; ++k) times.push_back(begin + (end - begin) * k / steps);
  };
  add(0, timeline.cut_begins(), 1);
  add(timeline.cut_begins(), timeline.cut_ends(), kLeastOfCut);
  add(timeline.cut_ends(), timeline.end(), 1);
  return times;
}

}  // namespace

RobotTrajectory trajectory_of(const JointSpline& spline, const BladeChain& chain,
                              const Timeline& timeline, const ValueLimits& limits) {
  RobotTrajectory trajectory;
  for (std::size_t i = 0; i < chain.size(); ++i)
    trajectory.names.push_back(chain.description(i).name);
  for (const double time : trajectory_times(timeline)) {
    trajectory.times.push_back(time);
    // Sums of control points within limits leave them by rounding only.
    const Values values = spline.at(time).cwiseMax(limits.lower).cwiseMin(limits.upper);
    trajectory.values.insert(trajectory.values.end(), values.data(), values.data() + values.size());
  }
  return trajectory;
}

PlacedMargin margin_of(const BladeChain& chain, std::size_t i, const RobotTrajectory& trajectory,
                       const Timeline& timeline) {
  const std::size_t width = trajectory.names.size();
  const auto at = [&](std::size_t k) { return trajectory.values[k * width + i]; };
  const RobotValue& value = chain.description(i);
  PlacedMargin placed;
  ValueMargin& margin = placed.margin;
  margin = {value.name, at(0), at(0), 0, 0, chain.speed_limit(i), 0};
  double before = 0, seconds_before = 0;
  for (std::size_t k = 0; k < trajectory.times.size(); ++k) {
    margin.least = std::min(margin.least, at(k));
    margin.greatest = std::max(margin.greatest, at(k));
    if (k == 0) continue;
    const double seconds = trajectory.times[k] - trajectory.times[k - 1];
    const double speed = (at(k) - at(k - 1)) / seconds;
    const double share = timeline.share_at(trajectory.times[k]);
    if (std::abs(speed) > margin.greatest_speed) {
      margin.greatest_speed = std::abs(speed);
      placed.fastest_share = share;
    }
    const double acceleration =
        k > 1 ? std::abs(speed - before) / (0.5 * (seconds + seconds_before)) : 0;
    if (acceleration > margin.greatest_acceleration) {
      margin.greatest_acceleration = acceleration;
      placed.sharpest_share = share;
    }
    before = speed;
    seconds_before = seconds;
  }
  margin.to_limits = std::min(margin.least - value.lower, value.upper - margin.greatest);
  return placed;
}

void measure_errors(const JointSpline& spline, std::span<const TargetSample> samples,
                    BladeChain& chain, PlanReport& report) {
  report.most_place_error = report.most_depth_error = report.most_angle_error = 0;
  double place_sum = 0, depth_sum = 0, angle_sum = 0, count = 0, full_count = 0;
  BladePlace place;
  for (const TargetSample& sample : samples) {
    if (sample.lift > 0) continue;
    const Values values = spline.at(sample.time);
    chain.place({values.data(), chain.size()}, place, false);
    const PlainErrors errors = plain_errors(place, sample);
    report.most_place_error = std::max(report.most_place_error, errors.place);
    if (sample.is_full) report.most_depth_error = std::max(report.most_depth_error, errors.depth);
    report.most_angle_error = std::max(report.most_angle_error, errors.angle);
    place_sum += errors.place * errors.place;
    if (sample.is_full) depth_sum += errors.depth * errors.depth;
    angle_sum += errors.angle * errors.angle;
    count += 1;
    if (sample.is_full) full_count += 1;
  }
  report.mean_place_error = std::sqrt(place_sum / count);
  report.mean_depth_error = std::sqrt(depth_sum / full_count);
  report.mean_angle_error = std::sqrt(angle_sum / count);
}

}  // namespace sunder::plan
