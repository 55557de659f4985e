#include "pipeline/plan/inverse_kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>

#include "pipeline/plan/next_share.h"

namespace sunder::plan {
namespace {

constexpr int kMostIterations = 60;
constexpr double kLeastShare = 1e-9;  ///< Share of the cost.
constexpr double kSolved = 1e-10;     ///< A cost below counts as none.
constexpr double kSame = 0.05;        ///< Solutions whose values differ less are one.
constexpr std::uint64_t kSeed = 0x5d5eed;

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

Values random_values(const Values& rest, const ValueLimits& limits, std::uint64_t& state) {
  Values values(rest.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double low = std::max(limits.lower[i], rest[i] - std::numbers::pi);
    const double high = std::min(limits.upper[i], rest[i] + std::numbers::pi);
    values[i] = low + next_share(state) * (high - low);
  }
  return values;
}

std::vector<Values> solutions_of(BladeChain& chain, const TargetSample& sample,
                                 const ErrorScales& scales, const ValueLimits& limits,
                                 std::uint32_t seeds) {
  std::vector<std::pair<double, Values>> found;
  std::uint64_t state = kSeed;
  for (std::uint32_t seed = 0; seed <= seeds; ++seed) {
    Values values = seed == 0 ? chain.rest() : random_values(chain.rest(), limits, state);
    const double cost = solve_sample(chain, sample, scales, limits, values);
    const bool is_known = std::any_of(found.begin(), found.end(), [&](const auto& other) {
      return (other.second - values).cwiseAbs().maxCoeff() < kSame;
    });
    if (!is_known && std::isfinite(cost)) found.emplace_back(cost, std::move(values));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Values> solutions;
  for (auto& [cost, values] : found) solutions.push_back(std::move(values));
  if (solutions.empty()) solutions.push_back(chain.rest());
  return solutions;
}

}  // namespace sunder::plan
