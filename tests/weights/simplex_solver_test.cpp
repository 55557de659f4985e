#include "weights/simplex_solver.h"

#include <numeric>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/stress.h"
#include "support/oracles/simplex_oracle.h"

namespace sunder {
namespace {

struct Problem {
  Eigen::MatrixXd gram;
  Eigen::VectorXd linear;
  std::vector<double> start;
};

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, test::Random& random) {
  return Eigen::MatrixXd::NullaryExpr(
      rows, columns, [&](Eigen::Index, Eigen::Index) { return random.uniform(-1, 1); });
}

/// Weights with sum 1, some of them zero.
std::vector<double> random_weights(std::size_t count, test::Random& random) {
  std::vector<double> weights(count);
  for (double& weight : weights) weight = random.index(2) == 0 ? 0.0 : random.uniform(0.01, 1);
  weights[random.index(static_cast<std::uint32_t>(count))] = 1;
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// The Gram matrix of the errors of `count` bones in `rows` coordinates: singular if `rows` is less
/// than `count`.
Problem random_problem(std::size_t count, Eigen::Index rows, test::Random& random) {
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd off = random_matrix(rows, n, random);
  if (random.index(3) == 0)
    off.col(random.index(static_cast<std::uint32_t>(count))) = off.col(0);  // bones that move alike
  if (random.index(2) == 0)
    off.colwise() += 2 * random_matrix(rows, 1, random).col(0);  // away from the hull
  Problem problem{off.transpose() * off, Eigen::VectorXd::Zero(n), random_weights(count, random)};
  // As in the fit of a point: a cost for changing the weights.
  const double tie = 1e-13 * problem.gram.diagonal().maxCoeff();
  problem.gram.diagonal().array() += tie;
  for (Eigen::Index i = 0; i < n; ++i)
    problem.linear[i] = tie * problem.start[static_cast<std::size_t>(i)];
  return problem;
}

void fill(const Problem& problem, weights::SimplexSolver& solver) {
  const std::size_t n = problem.start.size();
  solver.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    solver.linear(i) = problem.linear[static_cast<Eigen::Index>(i)];
    for (std::size_t j = 0; j < n; ++j)
      solver.gram(i, j) = problem.gram(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
}

void expect_on_simplex(const std::vector<double>& weights) {
  for (const double weight : weights) EXPECT_GE(weight, 0);
  EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-12);
}

TEST(SimplexSolver, finds_the_same_as_trying_every_support) {
  test::Random random(1);
  weights::SimplexSolver solver;
  for (int i = 0; i < test::stressed(2000, 20); ++i) {
    const std::size_t count = 1 + random.index(7);
    const Problem problem = random_problem(count, 1 + random.index(12), random);
    fill(problem, solver);
    std::vector<double> weights = problem.start;
    solver.solve(weights, std::vector<bool>(count, true));
    expect_on_simplex(weights);
    EXPECT_LE(solver.value(weights),
              solver.value(problem.start) + 1e-15 * problem.gram.diagonal().maxCoeff());
    const test::SimplexOptimum best = test::best_on_simplex(problem.gram, problem.linear, count);
    EXPECT_NEAR(solver.value(weights), best.value, 1e-10 * problem.gram.diagonal().maxCoeff())
        << "case " << i;
  }
}

TEST(SimplexSolver, linear_terms_count) {
  test::Random random(2);
  weights::SimplexSolver solver;
  for (int i = 0; i < 500; ++i) {
    const std::size_t count = 1 + random.index(7);
    Problem problem = random_problem(count, 10, random);
    problem.linear = random_matrix(problem.linear.size(), 1, random);
    fill(problem, solver);
    std::vector<double> weights = problem.start;
    solver.solve(weights, std::vector<bool>(count, true));
    expect_on_simplex(weights);
    const test::SimplexOptimum best = test::best_on_simplex(problem.gram, problem.linear, count);
    EXPECT_NEAR(solver.value(weights), best.value, 1e-9 * (1 + problem.gram.diagonal().maxCoeff()))
        << "case " << i;
  }
}

TEST(SimplexSolver, weights_that_are_not_allowed_stay_zero) {
  test::Random random(3);
  weights::SimplexSolver solver;
  for (int i = 0; i < 500; ++i) {
    const std::size_t count = 2 + random.index(6);
    const Problem problem = random_problem(count, 10, random);
    fill(problem, solver);
    std::vector<double> weights = problem.start;
    std::vector<bool> allowed(count);
    std::vector<int> slots;
    for (std::size_t k = 0; k < count; ++k) {
      allowed[k] = weights[k] > 0 || random.index(2) == 0;
      if (allowed[k]) slots.push_back(static_cast<int>(k));
    }
    solver.solve(weights, allowed);
    expect_on_simplex(weights);
    for (std::size_t k = 0; k < count; ++k)
      if (!allowed[k]) {
        EXPECT_EQ(weights[k], 0);
      }
    const test::SimplexOptimum best =
        test::best_on_simplex(problem.gram(slots, slots), problem.linear(slots), count);
    EXPECT_NEAR(solver.value(weights), best.value, 1e-10 * problem.gram.diagonal().maxCoeff())
        << "case " << i;
  }
}

TEST(SimplexSolver, a_form_that_is_zero_leaves_the_weights) {
  weights::SimplexSolver solver;
  const std::vector<double> start = {0.25, 0, 0.75};
  fill({Eigen::MatrixXd::Zero(3, 3), Eigen::VectorXd::Zero(3), start}, solver);
  std::vector<double> weights = start;
  solver.solve(weights, {true, true, true});
  EXPECT_EQ(weights, start);
}

}  // namespace
}  // namespace sunder
