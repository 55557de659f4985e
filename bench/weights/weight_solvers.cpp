#include "bench/weights/weight_solvers.h"

#include <algorithm>
#include <array>

#include "bench/harness/measure.h"

#if SUNDER_BENCH_TINY_SOLVER
#include <ceres/tiny_solver.h>
#endif
#if SUNDER_BENCH_CERES
#include <ceres/ceres.h>
#endif

namespace sunder::bench {
namespace {

#if SUNDER_BENCH_TINY_SOLVER || SUNDER_BENCH_CERES

/// A w - b with w = x^2 / |x|^2.
template <int N>
struct Squares {
  using Scalar = double;
  enum { NUM_RESIDUALS = WeightProblem::kRows, NUM_PARAMETERS = N };
  using Parameters = Eigen::Matrix<double, N, 1>;

  const WeightProblem* problem = nullptr;

  static Parameters weights(const Parameters& x) { return x.cwiseAbs2() / x.squaredNorm(); }

  /// @param jacobian  Column-major, or null.
  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    const Parameters x = Eigen::Map<const Parameters>(parameters);
    const Parameters w = weights(x);
    const auto matrix = problem->matrix.template leftCols<N>();
    Eigen::Map<Eigen::Matrix<double, NUM_RESIDUALS, 1>> off(residuals);
    const Eigen::Matrix<double, NUM_RESIDUALS, 1> at = matrix * w;
    off = at - problem->target;
    if (jacobian == nullptr) return true;
    Eigen::Map<Eigen::Matrix<double, NUM_RESIDUALS, N>> slopes(jacobian);
    for (int i = 0; i < N; ++i) slopes.col(i) = (2 * x[i] / x.squaredNorm()) * (matrix.col(i) - at);
    return true;
  }
};

/// Solves a problem of N bones, starting from the square root of its start. @return the weights.
template <int N, class Solve>
double mean_square_of(const WeightProblem& problem, Solve&& solve) {
  using Parameters = typename Squares<N>::Parameters;
  const Squares<N> residual{&problem};
  Parameters x = problem.start.template head<N>().cwiseSqrt();
  solve(residual, x);
  const Parameters w = Squares<N>::weights(x);
  return (problem.matrix.template leftCols<N>() * w - problem.target).squaredNorm() /
         (WeightProblem::kRows / 3);
}

template <class Solve>
SolverFigures run(const char* name, const std::vector<WeightProblem>& problems, Solve solve) {
  SolverFigures figures;
  figures.name = name;
  figures.mean_squares.resize(problems.size());
  const auto seconds = sample({50, 2.0, 3}, [&] {
    return seconds_of([&] {
      for (std::size_t i = 0; i < problems.size(); ++i) {
        const WeightProblem& problem = problems[i];
        double& mean_square = figures.mean_squares[i];
        switch (problem.matrix.cols()) {
          case 2: mean_square = mean_square_of<2>(problem, solve); break;
          case 3: mean_square = mean_square_of<3>(problem, solve); break;
          default: mean_square = mean_square_of<4>(problem, solve);
        }
      }
    });
  });
  figures.microseconds = 1e6 * *std::min_element(seconds.begin(), seconds.end()) /
                         static_cast<double>(problems.size());
  return figures;
}

#endif

#if SUNDER_BENCH_TINY_SOLVER
SolverFigures run_tiny_solver(const std::vector<WeightProblem>& problems) {
  return run("ceres::TinySolver", problems,
             []<int N>(const Squares<N>& residual, Eigen::Matrix<double, N, 1>& x) {
               ceres::TinySolver<Squares<N>> solver;
               (void)solver.Solve(residual, &x);
             });
}
#endif

#if SUNDER_BENCH_CERES
template <int N>
class SquaresCost : public ceres::SizedCostFunction<WeightProblem::kRows, N> {
 public:
  explicit SquaresCost(const Squares<N>& residual) : residual_(residual) {}
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    Eigen::Matrix<double, WeightProblem::kRows, N> slopes;
    const bool wants_slopes = jacobians != nullptr && jacobians[0] != nullptr;
    residual_(parameters[0], residuals, wants_slopes ? slopes.data() : nullptr);
    if (!wants_slopes) return true;
    Eigen::Map<Eigen::Matrix<double, WeightProblem::kRows, N, Eigen::RowMajor>> rows(jacobians[0]);
    rows = slopes;
    return true;
  }

 private:
  Squares<N> residual_;
};

SolverFigures run_ceres(const std::vector<WeightProblem>& problems) {
  return run("ceres::Problem", problems,
             []<int N>(const Squares<N>& residual, Eigen::Matrix<double, N, 1>& x) {
               ceres::Problem problem;
               problem.AddResidualBlock(new SquaresCost<N>(residual), nullptr,
                                        x.data());  // The problem takes ownership.
               ceres::Solver::Options options;
               options.linear_solver_type = ceres::DENSE_QR;
               options.logging_type = ceres::SILENT;
               ceres::Solver::Summary summary;
               ceres::Solve(options, &problem, &summary);
             });
}
#endif

}  // namespace

std::vector<SolverFigures> run_other_solvers(
    [[maybe_unused]] const std::vector<WeightProblem>& problems) {
  std::vector<SolverFigures> figures;
#if SUNDER_BENCH_TINY_SOLVER
  figures.push_back(run_tiny_solver(problems));
#endif
#if SUNDER_BENCH_CERES
  figures.push_back(run_ceres(problems));
#endif
  return figures;
}

}  // namespace sunder::bench
