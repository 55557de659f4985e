#include "particles/motion/coupling_factor.h"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder {
namespace {

using particles::CouplingFactor;
using particles::SpringMatrix;

/// Springs between random rows, twice between some. Stiffnesses are powers of ten up to `most`.
SpringMatrix random_matrix(test::Random& random, Index rows, double most) {
  SpringMatrix matrix;
  SpringMatrix::Pattern& pattern = matrix.pattern;
  for (Index row = 0; row < rows; ++row) {
    for (Index i = random.index(4); row + 1 < rows && i > 0; --i) {
      pattern.columns.push_back(row + 1 + random.index(rows - row - 1));
      matrix.values.push_back(std::pow(10, random.uniform(-most, most)));
    }
    pattern.first.push_back(static_cast<Index>(pattern.columns.size()));
    matrix.grounds.push_back(std::pow(10, random.uniform(-most, most)));
  }
  return matrix;
}

/// @param weights  a row per node, a column per pull.
void add_pulls(const Eigen::MatrixXd& weights, SpringMatrix& matrix) {
  SpringMatrix::Pattern pattern;
  std::vector<double> values;
  pattern.pulls = static_cast<Index>(weights.cols());
  const auto nodes = static_cast<Index>(weights.rows());
  for (Index node = 0; node < nodes; ++node) {
    for (Index e = matrix.pattern.first[node]; e < matrix.pattern.first[node + 1]; ++e) {
      pattern.columns.push_back(matrix.pattern.columns[e]);
      values.push_back(matrix.values[e]);
    }
    for (Index pull = 0; pull < pattern.pulls; ++pull) {
      if (weights(node, pull) == 0) continue;
      pattern.columns.push_back(nodes + pull);
      values.push_back(weights(node, pull));
    }
    pattern.first.push_back(static_cast<Index>(pattern.columns.size()));
  }
  matrix.pattern = pattern;
  matrix.values = values;
}

/// Of the springs.
Eigen::MatrixXd dense(const SpringMatrix& of) {
  const auto rows = static_cast<Index>(of.grounds.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, rows);
  for (Index row = 0; row < rows; ++row) {
    matrix(row, row) += of.grounds[row];
    for (Index s = of.pattern.first[row]; s < of.pattern.first[row + 1]; ++s) {
      const Index column = of.pattern.columns[s];
      if (column >= rows) continue;
      matrix(row, row) += of.values[s];
      matrix(column, column) += of.values[s];
      matrix(row, column) -= of.values[s];
      matrix(column, row) -= of.values[s];
    }
  }
  return matrix;
}

TEST(coupling_factor, solves) {
  test::Random random(1);
  CouplingFactor factor;
  for (int trial = 0; trial < 300; ++trial) {
    const SpringMatrix matrix = random_matrix(random, random.index(60), 2);
    const std::size_t rows = matrix.grounds.size();
    factor.analyse(matrix.pattern);
    factor.factorise(matrix);
    Eigen::MatrixXd right(rows, 4);
    std::vector<Eigen::Vector4d> x(rows);
    for (std::size_t row = 0; row < rows; ++row)
      for (int i = 0; i < 4; ++i)
        x[row][i] = right(static_cast<Eigen::Index>(row), i) = random.uniform(-1, 1);
    factor.solve(x);
    const Eigen::MatrixXd wanted = dense(matrix).ldlt().solve(right);
    for (std::size_t row = 0; row < rows; ++row)
      ASSERT_LT((x[row].transpose() - wanted.row(static_cast<Eigen::Index>(row))).norm(),
                1e-9 * wanted.norm());
  }
}

TEST(coupling_factor, is_precise_however_much_stiffnesses_differ) {
  test::Random random(2);
  CouplingFactor factor;
  for (int trial = 0; trial < 300; ++trial) {
    const SpringMatrix matrix = random_matrix(random, 1 + random.index(60), 14);
    factor.analyse(matrix.pattern);
    factor.factorise(matrix);
    // Forces equal to the stiffnesses to the ground displace everything by 1, and no spring.
    std::vector<Eigen::Vector4d> x;
    for (const double ground : matrix.grounds) x.push_back(Eigen::Vector4d::Constant(ground));
    factor.solve(x);
    for (const Eigen::Vector4d& displacement : x)
      ASSERT_LT((displacement - Eigen::Vector4d::Ones()).norm(), 1e-13) << trial;
  }
}

TEST(coupling_factor, pulls_of_any_stiffness_are_met_and_never_push) {
  test::Random random(3);
  CouplingFactor factor;
  for (int trial = 0; trial < 1000; ++trial) {
    SpringMatrix matrix = random_matrix(random, 2 + random.index(20), 3);
    const auto nodes = static_cast<Index>(matrix.grounds.size());
    const Index pulls = 1 + random.index(3);
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(nodes, pulls);
    for (Index pull = 0; pull < pulls; ++pull) {
      for (int i = 0; i < 3; ++i) weights(random.index(nodes), pull) = random.uniform(0.01, 1);
      if (pull > 0 && random.index(2) == 0) weights.col(pull) = weights.col(0);
      matrix.compliances.push_back(std::pow(10, random.uniform(-40, 3)));
    }
    add_pulls(weights, matrix);
    factor.analyse(matrix.pattern);
    factor.factorise(matrix);

    // Targets of 1: no pull leaves the weighted sum beyond its target or moves it away.
    std::vector<Eigen::Vector4d> x(nodes + pulls, Eigen::Vector4d::Zero());
    const Index pulling = random.index(pulls);
    x[nodes + pulling].setConstant(-1);
    factor.solve(x);
    Eigen::VectorXd places(nodes);
    for (Index node = 0; node < nodes; ++node) places[node] = x[node].x();
    const double place = weights.col(pulling).dot(places);
    ASSERT_GT(place, 0) << trial;
    ASSERT_LT(place, 1 + 1e-9) << trial;
    if (pulls > 1) continue;
    const double soft = weights.col(0).dot(dense(matrix).ldlt().solve(weights).col(0));
    ASSERT_NEAR(place, soft / (soft + matrix.compliances[0]), 1e-9) << trial;
  }
}

}  // namespace
}  // namespace sunder
