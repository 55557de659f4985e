#include "bench/weights/refit_methods.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Dense>

#include "core/internal/ordered.h"
#include "weights/simplex_solver.h"

namespace sunder::bench {
namespace {

constexpr int kMostTurns = 30;
constexpr double kLeastGain = 1e-5;  // of a turn
constexpr int kSweeps = 10;
/// Relative: bones that move alike share their weight as they did before.
constexpr double kTie = 1e-9;

/// Where bones carry a bind position.
Eigen::Vector3d carried(const Affine3d& bone, const Vec3d& position) {
  return Eigen::Vector3d(transform(bone, position));
}

/// The weights of one point as a least squares problem over the simplex.
class WeightProblem {
 public:
  /// @param exact  of the point; its slots are the candidates.
  explicit WeightProblem(const AnimationPoint& exact) {
    for (const AnimationPoint::Term& term : exact.terms()) slots_.push_back(term.slot);
    columns_.resize(slots_.size());
  }

  /// @param target_of  called with the number of each pose.
  template <class Target>
  void begin(const PosedPoints& poses, std::uint32_t skin, const Vec3d& position,
             std::span<const double> before, const Target& target_of) {
    const std::size_t n = slots_.size();
    solver_.resize(n);
    effects_.assign(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      solver_.linear(i) = 0;
      for (std::size_t j = 0; j < n; ++j) solver_.gram(i, j) = 0;
    }
    for (std::size_t p = 0; p < poses.poses.size(); ++p) {
      const PosedPoints::Pose& pose = poses.poses[p];
      const Eigen::Vector3d target = target_of(p);
      for (std::size_t i = 0; i < n; ++i) {
        columns_[i] = carried(pose.palettes[skin][slots_[i]], position) - target;
        effects_[i] += pose.weight * columns_[i].squaredNorm();
      }
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          solver_.gram(i, j) += pose.weight * columns_[i].dot(columns_[j]);
    }
    const double tie = kTie * *std::max_element(effects_.begin(), effects_.end()) + 1e-280;
    for (std::size_t i = 0; i < n; ++i) {
      solver_.gram(i, i) += tie;
      solver_.linear(i) = tie * before[i];
    }
  }

  /// Solves over the allowed bones, starting from weights with sum 1.
  void solve(std::vector<double>& weights, std::vector<bool>& allowed) {
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (!allowed[i]) weights[i] = 0;
      sum += weights[i];
    }
    const auto count = static_cast<double>(std::ranges::count(allowed, true));
    for (std::size_t i = 0; i < weights.size(); ++i)
      weights[i] = sum > 0 ? weights[i] / sum : (allowed[i] ? 1 / count : 0.0);
    solver_.solve(weights, allowed);
  }

  /// Leaves at most `most` positive weights, and solves for these again.
  void reduce(std::size_t most, Reduction reduction, std::vector<double>& weights,
              std::vector<bool>& allowed) {
    while (used(weights) > most) {
      std::vector<std::size_t> order;
      for (std::size_t i = 0; i < weights.size(); ++i)
        if (weights[i] > 0) order.push_back(i);
      const auto worth = [&](std::size_t i) {
        return reduction == Reduction::by_effect ? weights[i] * weights[i] * effects_[i]
                                                 : weights[i];
      };
      std::ranges::stable_sort(order, std::greater<>(), worth);
      order.resize(reduction == Reduction::by_effect ? most : order.size() - 1);
      allowed.assign(weights.size(), false);
      for (const std::size_t i : order) allowed[i] = true;
      solve(weights, allowed);
    }
    for (std::size_t i = 0; i < weights.size(); ++i) allowed[i] = weights[i] > 0;
  }

  [[nodiscard]] std::vector<double> weights_of(std::span<const Influence> influences) const {
    std::vector<double> weights(slots_.size(), 0.0);
    double sum = 0;
    for (const Influence& influence : influences) sum += static_cast<double>(influence.weight);
    for (const Influence& influence : influences)
      weights[static_cast<std::size_t>(std::ranges::find(slots_, influence.slot) -
                                       slots_.begin())] +=
          static_cast<double>(influence.weight) / sum;
    return weights;
  }
  [[nodiscard]] std::vector<Influence> influences_of(std::span<const double> weights) const {
    std::vector<Influence> influences;
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (weights[i] > 0) influences.push_back({slots_[i], static_cast<float>(weights[i])});
    return influences;
  }

 private:
  [[nodiscard]] static std::size_t used(std::span<const double> weights) {
    return static_cast<std::size_t>(std::ranges::count_if(weights, [](double w) { return w > 0; }));
  }

  std::vector<std::uint32_t> slots_;
  std::vector<Eigen::Vector3d> columns_;
  std::vector<double> effects_;  ///< Per bone: how far it alone would carry the point off.
  weights::SimplexSolver solver_;
};

/// The bind position with the least squared error for some weights.
Vec3d best_position(const PosedPoints& poses, std::size_t point, std::uint32_t skin,
                    const PointSkin& fit) {
  Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const PosedPoints::Pose& pose : poses.poses) {
    Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
    Eigen::Vector3d error = -Eigen::Vector3d(pose.exact[point]);
    for (const Influence& influence : fit.influences) {
      const Affine3d& bone = pose.palettes[skin][influence.slot];
      linear += static_cast<double>(influence.weight) * Eigen::Matrix3d(bone.linear());
      error += static_cast<double>(influence.weight) * carried(bone, fit.position);
    }
    left += pose.weight * linear.transpose() * linear;
    right -= pose.weight * linear.transpose() * error;
  }
  left.diagonal().array() += kTie * left.trace();
  return Vec3d(Eigen::Vector3d(fit.position) + left.ldlt().solve(right));
}

/// Alternates over the allowed bones until a turn gains next to nothing.
void take_turns(const PointsToFit& of, std::size_t point, WeightProblem& problem,
                std::vector<double>& weights, std::vector<bool>& allowed, PointSkin& fit) {
  const std::uint32_t skin = of.points[point].skin;
  const std::vector<double> before = problem.weights_of(of.barycentric[point].influences);
  double value = 1e300;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    problem.begin(of.poses, skin, fit.position, before,
                  [&](std::size_t p) -> Eigen::Vector3d { return of.poses.poses[p].exact[point]; });
    problem.solve(weights, allowed);
    fit.influences = problem.influences_of(weights);
    fit.position = best_position(of.poses, point, skin, fit);
    const double now = mean_square(of.poses, point, skin, fit);
    if (!(now < (1 - kLeastGain) * value)) return;
    value = now;
  }
}

/// The error of a point in every pose.
std::vector<Eigen::Vector3d> errors_of(const PosedPoints& poses, std::size_t point,
                                       std::uint32_t skin, const PointSkin& fit) {
  std::vector<Eigen::Vector3d> errors;
  double sum = 0;
  for (const Influence& influence : fit.influences) sum += static_cast<double>(influence.weight);
  for (const PosedPoints::Pose& pose : poses.poses) {
    Eigen::Vector3d& error = errors.emplace_back(-Eigen::Vector3d(pose.exact[point]));
    for (const Influence& influence : fit.influences)
      error += static_cast<double>(influence.weight) / sum *
               carried(pose.palettes[skin][influence.slot], fit.position);
  }
  return errors;
}

}  // namespace

double mean_square(const PosedPoints& poses, std::size_t point, std::uint32_t skin,
                   const PointSkin& fit) {
  const std::vector<Eigen::Vector3d> errors = errors_of(poses, point, skin, fit);
  double sum = 0, weights = 0;
  for (std::size_t p = 0; p < errors.size(); ++p) {
    sum += poses.poses[p].weight * errors[p].squaredNorm();
    weights += poses.poses[p].weight;
  }
  return weights > 0 ? sum / weights : 0.0;
}

std::vector<PointSkin> fit_in_turns(const PointsToFit& of, Reduction reduction) {
  std::vector<PointSkin> fits;
  for (std::size_t point = 0; point < of.points.size(); ++point) {
    PointSkin fit = of.barycentric[point];
    WeightProblem problem(of.points[point].exact);
    std::vector<double> weights = problem.weights_of(fit.influences);
    std::vector<bool> allowed(weights.size(), true);
    take_turns(of, point, problem, weights, allowed, fit);
    problem.reduce(of.most, reduction, weights, allowed);
    take_turns(of, point, problem, weights, allowed, fit);
    fits.push_back(std::move(fit));
  }
  return fits;
}

std::vector<PointSkin> fit_differences(const PointsToFit& of) {
  std::vector<PointSkin> fits(of.barycentric.begin(), of.barycentric.end());
  std::vector<std::vector<Index>> around(of.points.size());  // kNone: untorn, without an error
  for (const RefitNeighbours& pair : of.neighbours) {
    around[pair.a].push_back(pair.b);
    if (pair.b != kNone) around[pair.b].push_back(pair.a);
  }
  std::vector<std::vector<Eigen::Vector3d>> errors;
  for (std::size_t point = 0; point < fits.size(); ++point)
    errors.push_back(errors_of(of.poses, point, of.points[point].skin, fits[point]));
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t point = 0; point < fits.size(); ++point) {
      WeightProblem problem(of.points[point].exact);
      const std::vector<double> before = problem.weights_of(of.barycentric[point].influences);
      problem.begin(of.poses, of.points[point].skin, fits[point].position, before,
                    [&](std::size_t p) -> Eigen::Vector3d {
                      Eigen::Vector3d target = of.poses.poses[p].exact[point];
                      for (const Index other : around[point])
                        if (other != kNone)
                          target += errors[other][p] / static_cast<double>(around[point].size());
                      return target;
                    });
      std::vector<double> weights = problem.weights_of(fits[point].influences);
      std::vector<bool> allowed(weights.size(), true);
      problem.solve(weights, allowed);
      problem.reduce(of.most, Reduction::smallest_first, weights, allowed);
      fits[point].influences = problem.influences_of(weights);
      errors[point] = errors_of(of.poses, point, of.points[point].skin, fits[point]);
    }
  return fits;
}

}  // namespace sunder::bench
