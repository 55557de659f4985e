#pragma once

#include <vector>

#include <Eigen/Core>

namespace sunder::bench {

/// Weights w >= 0 with sum 1, at most four, for which A w is closest to b: three rows per pose,
/// sixteen poses, a column per bone.
struct WeightProblem {
  static constexpr int kRows = 48;
  Eigen::Matrix<double, kRows, Eigen::Dynamic, 0, kRows, 4> matrix;  ///< A.
  Eigen::Matrix<double, kRows, 1> target;                            ///< b.
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1> start;           ///< w, all > 0.
};

/// The time that another solver takes for such problems, and the quality of its weights.
struct SolverFigures {
  const char* name = "";
  double microseconds = 0;           ///< A problem: the least of many runs over all of them.
  std::vector<double> mean_squares;  ///< One a problem: |A w - b|^2 by the number of poses.
};

/// Those that were found when this was built: Levenberg-Marquardt by ceres::TinySolver, and by a
/// ceres::Problem for each problem. Both with weights as squares by their sum, and derivatives by
/// hand.
[[nodiscard]] std::vector<SolverFigures> run_other_solvers(
    const std::vector<WeightProblem>& problems);

}  // namespace sunder::bench
