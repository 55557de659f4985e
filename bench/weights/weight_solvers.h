#pragma once

#include <vector>

#include <Eigen/Core>

namespace sunder::bench {

/// A problem: weights w >= 0 with sum 1, at most four of them, that minimise |A w - b|. A has three
/// rows per pose, sixteen poses, and a column per bone.
struct WeightProblem {
  static constexpr int kRows = 48;
  Eigen::Matrix<double, kRows, Eigen::Dynamic, 0, kRows, 4> matrix;  ///< A.
  Eigen::Matrix<double, kRows, 1> target;                            ///< b.
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1> start;           ///< w, all > 0.
};

/// The time of another solver for such problems, and the quality of its weights.
struct SolverFigures {
  const char* name = "";
  double microseconds = 0;  ///< Per problem; the minimum of many runs over all of them.
  /// One per problem: |A w - b|^2 divided by the number of poses.
  std::vector<double> mean_squares;
};

/// The solvers found by the build: Levenberg-Marquardt by ceres::TinySolver, and by a
/// ceres::Problem per problem. Both represent weights as squares divided by their sum, with
/// analytic derivatives.
[[nodiscard]] std::vector<SolverFigures> run_other_solvers(
    const std::vector<WeightProblem>& problems);

}  // namespace sunder::bench
