#include "pipeline/plan/find_obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sunder::plan {
namespace {

constexpr double kAtLimit = 1e-6;  ///< Radians or metres.
constexpr std::uint32_t kSeeds = 24;
constexpr double kDepthTolerance = 0.5;  ///< Share of the wanted depth.

/// Whether some values within limits reach the sample.
bool can_reach(BladeChain& chain, const TargetSample& sample, const ErrorScales& scales,
               const ValueLimits& limits, const Values& start, double tolerance) {
  Values near = start;
  solve_sample(chain, sample, scales, limits, near);
  if (is_reached(chain, sample, near, tolerance)) return true;
  for (const double angle : {scales.angle, 1.0, std::numeric_limits<double>::infinity()}) {
    ErrorScales leaning = scales;  // at any angle, if it must
    leaning.angle = angle;
    const std::vector<Values> found = solutions_of(chain, sample, leaning, limits, kSeeds);
    const bool is_one = std::any_of(found.begin(), found.end(), [&](const Values& values) {
      return is_reached(chain, sample, values, tolerance);
    });
    if (is_one) return true;
  }
  return false;
}

void take_away(ValueLimits& limits, Eigen::Index i) {
  limits.lower[i] = -std::numeric_limits<double>::infinity();
  limits.upper[i] = std::numeric_limits<double>::infinity();
}

}  // namespace

bool is_reached(BladeChain& chain, const TargetSample& sample, const Values& values,
                double tolerance) {
  BladePlace place;
  chain.place({values.data(), chain.size()}, place, false);
  const PlainErrors errors = plain_errors(place, sample);
  // Where the blade goes down and rises, it may be as deep as elsewhere.
  const double allowed = kDepthTolerance * sample.full_depth;
  const bool is_deep_enough =
      errors.tip_depth >= sample.depth - allowed && errors.tip_depth <= sample.full_depth + allowed;
  return errors.place <= tolerance && is_deep_enough && errors.is_base_outside;
}

ReachedPart reached_part(BladeChain& chain, std::span<const TargetSample> samples,
                         std::span<const Values> values, double tolerance) {
  ReachedPart part{std::any_of(samples.begin(), samples.end(),
                               [](const TargetSample& sample) { return sample.depth > 0; }),
                   0, 0};
  std::size_t first = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].depth <= 0) {  // above the surface
      first = i + 1;
      continue;
    }
    if (!is_reached(chain, samples[i], values[i], tolerance)) {
      part.is_whole = false;
      first = i + 1;
      continue;
    }
    if (i + 1 - first > part.end - part.first) {
      part.first = first;
      part.end = i + 1;
    }
  }
  return part;
}

std::vector<PlanObstacle> find_obstacles(BladeChain& chain, const TargetSample& sample,
                                         const ErrorScales& scales, const ValueLimits& limits,
                                         const Values& values, double tolerance) {
  std::vector<PlanObstacle> found, together;
  if (can_reach(chain, sample, scales, limits, values, tolerance)) return found;
  ValueLimits all = limits;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const auto index = static_cast<Eigen::Index>(i);
    if (values[index] > limits.lower[index] + kAtLimit &&
        values[index] < limits.upper[index] - kAtLimit)
      continue;
    const PlanObstacle obstacle{PlanObstacle::Kind::joint_limit, chain.description(i).name,
                                sample.share};
    together.push_back(obstacle);
    take_away(all, index);
    ValueLimits without = limits;
    take_away(without, index);
    if (can_reach(chain, sample, scales, without, values, tolerance)) found.push_back(obstacle);
  }
  if (!found.empty()) return found;
  if (!together.empty() && can_reach(chain, sample, scales, all, values, tolerance))
    return together;
  std::vector<PlanObstacle> any;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const auto index = static_cast<Eigen::Index>(i);
    if (!std::isfinite(limits.lower[index]) && !std::isfinite(limits.upper[index])) continue;
    any.push_back({PlanObstacle::Kind::joint_limit, chain.description(i).name, sample.share});
    take_away(all, index);
  }
  if (can_reach(chain, sample, scales, all, values, tolerance)) return any;
  return {{PlanObstacle::Kind::reach, "", sample.share}};
}

}  // namespace sunder::plan
