#include "pipeline/plan/fit_spline.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <utility>

#include <Eigen/Cholesky>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <ceres/types.h>

#include "pipeline/plan/spline_costs.h"

namespace sunder::plan {
namespace {

constexpr int kMostSteps = 60;
constexpr double kLeastGain = 1e-7;  ///< The solver stops when a step gains less of the cost.
/// Errors of one: third differences of control points, radians or metres.
constexpr double kRough = 2e-2;
/// Differences from the start, which hold what nothing else does, such as turns of a blade about
/// its own axis.
constexpr double kAway = 1.0;
constexpr double kMotionAtEnds = 1e-3;  ///< Differences at the ends, where the robot stands.
/// Share of a limit of speed or acceleration up to which there is no cost, because the costs leave
/// a small excess.
constexpr double kOfLimit = 0.97;
constexpr double kNearness = 0.05;  ///< Share of the clearance that is an error of one.
constexpr double kExcess = 2e-3;    ///< Share of a limit that is an error of one.

/// The spline nearest to values at the samples, by linear least squares with a little smoothing.
std::vector<Values> fit_values(std::span<const Values> values,
                               std::span<const TargetSample> samples,
                               std::span<const double> knots) {
  const auto count = static_cast<Eigen::Index>(knots.size() + 2), size = values[0].size();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, size);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const SplineWeights of = spline_weights(samples[i].time, knots);
    const auto first = static_cast<Eigen::Index>(of.first);
    for (Eigen::Index a = 0; a < 4; ++a) {
      const double weight = of.weights[static_cast<std::size_t>(a)];
      right.row(first + a) += weight * values[i].transpose();
      for (Eigen::Index b = 0; b < 4; ++b)
        normal(first + a, first + b) += weight * of.weights[static_cast<std::size_t>(b)];
    }
  }
  const double stencil[3] = {1, -2, 1};
  for (Eigen::Index i = 0; i + 2 < count; ++i)
    for (Eigen::Index a = 0; a < 3; ++a)
      for (Eigen::Index b = 0; b < 3; ++b) normal(i + a, i + b) += 1e-3 * stencil[a] * stencil[b];
  const Eigen::MatrixXd solved = normal.ldlt().solve(right);
  std::vector<Values> control;
  for (Eigen::Index i = 0; i < count; ++i) control.emplace_back(solved.row(i).transpose());
  return control;
}

std::vector<double> times(double factor, std::vector<double> weights) {
  for (double& weight : weights) weight *= factor;
  return weights;
}

/// The problem that Ceres solves.
class SplineProblem {
 public:
  SplineProblem(BladeChain& chain, JointSpline& spline) : chain_(chain), spline_(spline) {}

  void add_errors(const std::vector<TargetSample>& samples, const ErrorScales& scales) {
    for (const TargetSample& sample : samples) {
      const SplineWeights of = spline_weights(sample.time, spline_.knots);
      problem_.AddResidualBlock(new BladeCost(chain_, sample, scales, of.weights), nullptr,
                                blocks(of.first, 4));
    }
  }

  void add_kept_away(const KeptAway& kept_away) {
    for (const NearPlace& near : kept_away.places) {
      const SplineWeights of = spline_weights(near.time, spline_.knots);
      problem_.AddResidualBlock(
          new ClearanceCost(chain_, kept_away.shapes[near.shape], near, kept_away.margin,
                            kNearness * kept_away.margin, of.weights),
          nullptr, blocks(of.first, 4));
    }
  }

  void add_smoothness() {
    const std::size_t count = spline_.control.size();
    for (std::size_t i = 0; i + 3 < count; ++i) {
      const double step = spline_.knots[i + 1] - spline_.knots[i];
      add(times(step * step * step, derivative_weights(spline_.knots, 3, i)), i, kRough);
    }
    for (std::size_t i = 0; i < count; ++i)
      problem_.AddResidualBlock(
          new StencilCost({1}, Values::Constant(size(), 1 / kAway), spline_.control[i]), nullptr,
          blocks(i, 1));
    add_rest(0, spline_.knots[1] - spline_.knots[0]);
    add_rest(count - 3, spline_.duration() - spline_.knots[spline_.intervals() - 1]);
  }

  void add_limits(const SplineLimits& limits) {
    const std::size_t count = spline_.control.size();
    if (has_any(limits.speed))
      for (std::size_t i = 0; i + 1 < count; ++i) add_excess(1, limits.speed, i);
    if (has_any(limits.acceleration))
      for (std::size_t i = 0; i + 2 < count; ++i) add_excess(2, limits.acceleration, i);
    for (Values& control : spline_.control)
      for (int i = 0; i < static_cast<int>(size()); ++i) {
        if (std::isfinite(limits.values.lower[i]))
          problem_.SetParameterLowerBound(control.data(), i, limits.values.lower[i]);
        if (std::isfinite(limits.values.upper[i]))
          problem_.SetParameterUpperBound(control.data(), i, limits.values.upper[i]);
      }
  }

  void solve() {
    ceres::Solver::Options options;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = kMostSteps;
    options.function_tolerance = kLeastGain;
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    options.dense_linear_algebra_library_type = ceres::EIGEN;
    options.linear_solver_type =
        ceres::IsSparseLinearAlgebraLibraryTypeAvailable(ceres::EIGEN_SPARSE)
            ? ceres::SPARSE_NORMAL_CHOLESKY
            : ceres::DENSE_NORMAL_CHOLESKY;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
  }

 private:
  static bool has_any(const Values& limits) {
    return std::any_of(limits.data(), limits.data() + limits.size(),
                       [](double limit) { return std::isfinite(limit); });
  }
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(chain_.size()); }

  std::vector<double*> blocks(std::size_t first, std::size_t count) {
    std::vector<double*> of;
    for (std::size_t i = 0; i < count; ++i) of.push_back(spline_.control[first + i].data());
    return of;
  }

  void add(const std::vector<double>& stencil, std::size_t first, double scale) {
    problem_.AddResidualBlock(
        new StencilCost(stencil, Values::Constant(size(), 1 / scale), Values::Zero(size())),
        nullptr, blocks(first, stencil.size()));
  }

  /// No speed and acceleration at the first or last knot, beside which knots are `step` apart.
  void add_rest(std::size_t first, double step) {
    std::vector<double> speed = derivative_weights(spline_.knots, 1, first);
    const std::vector<double> next = derivative_weights(spline_.knots, 1, first + 1);
    speed[1] += next[0];
    speed.push_back(next[1]);
    add(times(step, std::move(speed)), first, kMotionAtEnds);
    add(times(step * step, derivative_weights(spline_.knots, 2, first)), first, kMotionAtEnds);
  }

  void add_excess(std::size_t order, const Values& limits, std::size_t first) {
    problem_.AddResidualBlock(
        new ExcessCost(derivative_weights(spline_.knots, order, first), kOfLimit * limits, kExcess),
        nullptr, blocks(first, order + 1));
  }

  BladeChain& chain_;
  JointSpline& spline_;
  ceres::Problem problem_;
};

}  // namespace

JointSpline spline_through(std::span<const Values> values, std::span<const TargetSample> samples,
                           std::vector<double> knots, const ValueLimits& limits) {
  JointSpline spline;
  spline.control = fit_values(values, samples, knots);
  spline.knots = std::move(knots);
  for (Values& control : spline.control)
    control = control.cwiseMax(limits.lower).cwiseMin(limits.upper);
  return spline;
}

Result<JointSpline> fit_spline(BladeChain& chain, const std::vector<TargetSample>& samples,
                               const ErrorScales& scales, const SplineLimits& limits,
                               const KeptAway& kept_away, JointSpline start) {
  JointSpline spline = std::move(start);
  try {
    SplineProblem problem(chain, spline);
    problem.add_errors(samples, scales);
    problem.add_kept_away(kept_away);
    problem.add_smoothness();
    problem.add_limits(limits);
    problem.solve();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return Status::failure(StatusCode::internal_error, kNone, "Ceres: %s", error.what());
  }
  return spline;
}

}  // namespace sunder::plan
