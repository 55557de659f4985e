#include "pipeline/plan/inverse_kinematics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>

namespace sunder::plan {
namespace {

constexpr int kMostIterations = 60;
constexpr double kLeastShare = 1e-9;  ///< Share of the cost.
constexpr double kSolved = 1e-10;     ///< A cost below counts as none.
constexpr double kSame = 0.05;        ///< Solutions whose values differ less are one.
constexpr std::size_t kMostTracks = 6;
constexpr std::size_t kBestTracks = 3;
/// Cost of a change of values by one from a sample to the next, and of speeds at their limits.
constexpr double kChange = 1e-2, kAtSpeedLimit = 1;
constexpr std::uint64_t kSeed = 0x5d5eed;

/// SplitMix64 (Steele, Lea and Flood 2014).
double next_share(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

struct Solution {
  Values values;
  double cost = std::numeric_limits<double>::infinity();
};

/// One sample, and the state of the search for its values.
class SampleSolver {
 public:
  SampleSolver(BladeChain& chain, const TargetSample& sample, const ErrorScales& scales,
               const ValueLimits& limits)
      : chain_(chain), sample_(sample), scales_(scales_at(scales, sample)), limits_(limits) {}

  double run(Values& values) {
    values = values.cwiseMax(limits_.lower).cwiseMin(limits_.upper);
    double cost = evaluate(values, &rates_);
    double damping = 1e-3;
    for (int i = 0; i < kMostIterations && cost > kSolved && damping < 1e12; ++i) {
      const Values trial = stepped(values, damping);
      const double trial_cost = evaluate(trial, nullptr);
      if (!(trial_cost < cost)) {
        damping *= 8;
        continue;
      }
      const bool is_done = cost - trial_cost < kLeastShare * cost;
      values = trial;
      cost = evaluate(values, &rates_);
      damping = std::max(damping * 0.2, 1e-9);
      if (is_done) break;
    }
    return cost;
  }

 private:
  double evaluate(const Values& values, ErrorRates* rates) {
    chain_.place({values.data(), static_cast<std::size_t>(values.size())}, place_,
                 rates != nullptr);
    const BladeErrors errors = blade_errors(place_, sample_, scales_, rates);
    if (rates != nullptr) errors_ = errors;
    return 0.5 * errors.squaredNorm();
  }

  [[nodiscard]] Values stepped(const Values& values, double damping) const {
    const Values gradient = rates_.transpose() * errors_;
    Eigen::MatrixXd normal = rates_.transpose() * rates_;
    Values right = -gradient;
    const double floor = 1e-9 * normal.diagonal().maxCoeff() + 1e-12;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const bool is_held = (values[i] <= limits_.lower[i] && gradient[i] > 0) ||
                           (values[i] >= limits_.upper[i] && gradient[i] < 0);
      if (is_held) {
        normal.row(i).setZero();
        normal.col(i).setZero();
        right[i] = 0;
      }
      normal(i, i) += damping * normal(i, i) + damping * floor * 1e3 + floor;
    }
    const Values step = normal.ldlt().solve(right);
    return (values + step).cwiseMax(limits_.lower).cwiseMin(limits_.upper);
  }

  BladeChain& chain_;
  const TargetSample& sample_;
  ErrorScales scales_;
  const ValueLimits& limits_;
  BladePlace place_;
  BladeErrors errors_;
  ErrorRates rates_;
};

/// A random start: within limits, or within a turn or a metre of rest where there are none.
Values random_values(const Values& rest, const ValueLimits& limits, std::uint64_t& state) {
  Values values(rest.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double low = std::max(limits.lower[i], rest[i] - std::numbers::pi);
    const double high = std::min(limits.upper[i], rest[i] + std::numbers::pi);
    values[i] = low + next_share(state) * (high - low);
  }
  return values;
}

/// Different solutions for one sample, those with the least cost first.
std::vector<Solution> solutions_of(BladeChain& chain, const TargetSample& sample,
                                   const ErrorScales& scales, const ValueLimits& limits,
                                   std::uint32_t seeds) {
  std::vector<Solution> found;
  std::uint64_t state = kSeed;
  for (std::uint32_t seed = 0; seed <= seeds; ++seed) {
    Solution solution{seed == 0 ? chain.rest() : random_values(chain.rest(), limits, state), 0};
    solution.cost = solve_sample(chain, sample, scales, limits, solution.values);
    const bool is_known = std::any_of(found.begin(), found.end(), [&](const Solution& other) {
      return (other.values - solution.values).cwiseAbs().maxCoeff() < kSame;
    });
    if (!is_known && std::isfinite(solution.cost)) found.push_back(solution);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Solution& a, const Solution& b) { return a.cost < b.cost; });
  if (found.size() > kMostTracks) found.resize(kMostTracks);
  return found;
}

double change_cost(const Values& change, double seconds, const Values& speed_limits) {
  double cost = kChange * change.squaredNorm();
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    const double share = std::abs(change[i]) / (seconds * speed_limits[i]);
    cost += kAtSpeedLimit * share * share * share * share;
  }
  return cost;
}

}  // namespace

ValueLimits limits_of(const BladeChain& chain) {
  ValueLimits limits{chain.rest(), chain.rest()};
  for (std::size_t i = 0; i < chain.size(); ++i) {
    limits.lower[static_cast<Eigen::Index>(i)] = chain.description(i).lower;
    limits.upper[static_cast<Eigen::Index>(i)] = chain.description(i).upper;
  }
  return limits;
}

double solve_sample(BladeChain& chain, const TargetSample& sample, const ErrorScales& scales,
                    const ValueLimits& limits, Values& values) {
  return SampleSolver(chain, sample, scales, limits).run(values);
}

std::vector<std::vector<Values>> track_samples(BladeChain& chain,
                                               std::span<const TargetSample> samples,
                                               const ErrorScales& scales,
                                               const SplineLimits& limits, std::uint32_t seeds) {
  struct Track {
    std::vector<Values> values;
    double cost = 0;
  };
  std::vector<Track> tracks;
  const auto half = std::find_if(samples.begin(), samples.end(),
                                 [](const TargetSample& sample) { return sample.share >= 0.5; });
  // So that neither end is far from a solution.
  const std::size_t middle =
      half == samples.end() ? 0 : static_cast<std::size_t>(half - samples.begin());
  for (const Solution& start : solutions_of(chain, samples[middle], scales, limits.values, seeds)) {
    Track track{std::vector<Values>(samples.size()), 0};
    const auto follow = [&](std::size_t i, std::size_t before, const Values& from) {
      track.values[i] = from;
      track.cost += solve_sample(chain, samples[i], scales, limits.values, track.values[i]);
      if (i == before) return;
      const double seconds = std::abs(samples[i].time - samples[before].time);
      track.cost += change_cost(track.values[i] - from, seconds, limits.speed);
    };
    follow(middle, middle, start.values);
    for (std::size_t i = middle; i-- > 0;) follow(i, i + 1, track.values[i + 1]);
    for (std::size_t i = middle + 1; i < samples.size(); ++i) follow(i, i - 1, track.values[i - 1]);
    tracks.push_back(std::move(track));
  }
  std::stable_sort(tracks.begin(), tracks.end(),
                   [](const Track& a, const Track& b) { return a.cost < b.cost; });
  std::vector<std::vector<Values>> best;
  for (std::size_t i = 0; i < std::min(tracks.size(), kBestTracks); ++i)
    best.push_back(std::move(tracks[i].values));
  if (best.empty()) best.emplace_back(samples.size(), chain.rest());
  return best;
}

}  // namespace sunder::plan
