#include "bench/plan/pattern_search.h"

#include <algorithm>
#include <cmath>

#include "support/machine/random.h"

namespace sunder::bench {
namespace {

constexpr double kDepthShare = 0.45;  ///< Of the wanted depth; plans allow 0.5.
constexpr double kFirstStep = 0.1, kLastStep = 1e-5;

}  // namespace

PatternSearch::PatternSearch(const PlanTool& tool, double tolerance)
    : tool_(tool),
      kinematics_(*RobotKinematics::create(tool.robot)),
      tolerance_(tolerance),
      frames_(tool.robot.links.size()) {}

double PatternSearch::cost(const plan::TargetSample& sample,
                           const std::vector<double>& values) const {
  if (!kinematics_.evaluate(values, frames_, tool_.world_from_root)) return 1e30;
  const Vec3d base = frames_[tool_.blade.link] * tool_.blade.base;
  const Vec3d tip = frames_[tool_.blade.link] * tool_.blade.tip;
  const Vec3d along = (base - tip).normalized(), from = sample.place - tip;
  const double beside = from.cross(along).norm();
  const double tip_depth = from.dot(sample.normal);
  const double depth = std::max({sample.depth - tip_depth, tip_depth - sample.full_depth, 0.0});
  const double allowed = kDepthShare * sample.full_depth;
  const double inside = std::max(0.0, -(base - sample.place).dot(sample.normal));
  return beside / tolerance_ + std::max(0.0, depth - allowed) / tolerance_ +
         100 * inside / tolerance_;
}

bool PatternSearch::reach(const plan::TargetSample& sample, const std::vector<double>& lower,
                          const std::vector<double>& upper, std::vector<double>& values) const {
  constexpr double kEnough = 0.5;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = std::clamp(values[i], lower[i], upper[i]);
  double best = cost(sample, values);
  for (double size = kFirstStep; size > kLastStep && best > kEnough; size *= 0.5) {
    for (bool is_better = true; is_better && best > kEnough;) {
      const std::vector<double> before = values;
      is_better = false;
      for (std::size_t i = 0; i < values.size(); ++i)
        for (const double sign : {1.0, -1.0}) {
          const double kept = values[i];
          values[i] = std::clamp(kept + sign * size, lower[i], upper[i]);
          const double trial = cost(sample, values);
          if (trial < best - 1e-6) {
            best = trial;
            is_better = true;
          } else {
            values[i] = kept;
          }
        }
      std::vector<double> leap = values;  // on in the direction that helped
      for (std::size_t i = 0; i < leap.size(); ++i)
        leap[i] = std::clamp(2 * values[i] - before[i], lower[i], upper[i]);
      if (const double trial = cost(sample, leap); is_better && trial < best) {
        best = trial;
        values = leap;
      }
    }
  }
  return best <= 1;
}

bool PatternSearch::reach_from_anywhere(const plan::TargetSample& sample,
                                        const std::vector<double>& lower,
                                        const std::vector<double>& upper, int starts) const {
  test::Random random(5);
  for (int start = 0; start < starts; ++start) {
    std::vector<double> values;
    for (std::size_t i = 0; i < lower.size(); ++i)
      values.push_back(random.uniform(std::max(lower[i], -3.2), std::min(upper[i], 3.2)));
    if (reach(sample, lower, upper, values)) return true;
  }
  return false;
}

}  // namespace sunder::bench
