#include "support/oracles/quadratic_membrane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <Eigen/SparseCholesky>

namespace sunder::test {
namespace {

constexpr std::array kGaussPlaces = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                     0.8611363115940526};
constexpr std::array kGaussWeights = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                      0.3478548451374538};

/// The three quadratic functions on [-1, 1] and their slopes.
std::array<double, 3> quadratics(double t) {
  return {0.5 * t * (t - 1), 1 - t * t, 0.5 * t * (t + 1)};
}
std::array<double, 3> quadratic_slopes(double t) { return {t - 0.5, -2 * t, t + 0.5}; }

/// A line of the grid that bounds a part of it.
struct Border {
  double at = 0;
  bool is_singular = false;  ///< Whether the displacement has no derivative there.
};

/// The lines of a grid between borders, denser towards singular ones.
std::vector<double> graded(std::vector<Border> borders, int cells) {
  std::stable_sort(borders.begin(), borders.end(),
                   [](const Border& a, const Border& b) { return a.at < b.at; });
  const auto grade = [](double t) { return t * t * t; };
  std::vector<double> lines{borders[0].at};
  for (std::size_t i = 1; i < borders.size(); ++i) {
    const Border &from = borders[i - 1], &to = borders[i];
    for (int k = 1; k <= cells; ++k) {
      double t = static_cast<double>(k) / cells;
      if (from.is_singular && to.is_singular)
        t = t < 0.5 ? 0.5 * grade(2 * t) : 1 - 0.5 * grade(2 - 2 * t);
      else if (from.is_singular)
        t = grade(t);
      else if (to.is_singular)
        t = 1 - grade(1 - t);
      lines.push_back(k == cells ? to.at : from.at + t * (to.at - from.at));
    }
  }
  return lines;
}

std::size_t line_of(const std::vector<double>& lines, double at) {
  return static_cast<std::size_t>(std::lower_bound(lines.begin(), lines.end(), at) - lines.begin());
}

/// The cell that contains a place; of two, the later one if `is_after`.
std::size_t cell_of(const std::vector<double>& lines, double at, bool is_after) {
  const auto line = is_after ? std::upper_bound(lines.begin(), lines.end(), at)
                             : std::lower_bound(lines.begin(), lines.end(), at);
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
      line - lines.begin() - 1, 0, static_cast<std::ptrdiff_t>(lines.size()) - 2));
}

const TwoMembranes::Membrane& membrane_at(const TwoMembranes& of, double x, double y) {
  const bool is_second = (of.across == TwoMembranes::Across::x && x > of.border) ||
                         (of.across == TwoMembranes::Across::y && y > of.border);
  return is_second ? of.second : of.first;
}

/// The matrix of a cell for its nine functions.
Eigen::Matrix<double, 9, 9> cell_matrix(const GraphSurface& surface, const TwoMembranes& materials,
                                        const std::array<double, 2>& x,
                                        const std::array<double, 2>& y) {
  Eigen::Matrix<double, 9, 9> matrix = Eigen::Matrix<double, 9, 9>::Zero();
  const double half_x = 0.5 * (x[1] - x[0]), half_y = 0.5 * (y[1] - y[0]);
  const TwoMembranes::Membrane& of =
      membrane_at(materials, 0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b) {
      const double s = kGaussPlaces[a], t = kGaussPlaces[b];
      const Vec2d slope = surface.slope(x[0] + half_x * (1 + s), y[0] + half_y * (1 + t));
      const double root = std::sqrt(1 + slope.x() * slope.x() + slope.y() * slope.y());
      const double weight = kGaussWeights[a] * kGaussWeights[b] * half_x * half_y;
      // The inverse of the metric, times the root of its determinant.
      Eigen::Matrix2d inverse;
      inverse << 1 + slope.y() * slope.y(), -slope.x() * slope.y(), -slope.x() * slope.y(),
          1 + slope.x() * slope.x();
      inverse /= root;
      const auto fs = quadratics(s), ft = quadratics(t), ds = quadratic_slopes(s),
                 dt = quadratic_slopes(t);
      Eigen::Matrix<double, 9, 1> value;
      Eigen::Matrix<double, 9, 2> gradient;
      for (std::size_t k = 0; k < 9; ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        value[row] = fs[k % 3] * ft[k / 3];
        gradient(row, 0) = ds[k % 3] * ft[k / 3] / half_x;
        gradient(row, 1) = fs[k % 3] * dt[k / 3] / half_y;
      }
      matrix += weight * (of.stiffness * gradient * inverse * gradient.transpose() +
                          of.foundation * root * value * value.transpose());
    }
  return matrix;
}

/// The pull at the upper lip per x: tension times length, along the surface, away from the slit.
Vec3d pull_at(const GraphSurface& surface, double x, double tension) {
  const Vec2d slope = surface.slope(x, surface.slit_y);
  const Vec3d along(1, 0, slope.x()), normal(-slope.x(), -slope.y(), 1);
  return tension * normal.normalized().cross(along);
}

}  // namespace

QuadraticMembrane::QuadraticMembrane(const GraphSurface& surface, const TwoMembranes& materials,
                                     double newtons_per_metre, int cells) {
  std::vector<Border> in_x = {{0}, {surface.slit_begin, true}, {surface.slit_end, true}, {1}};
  std::vector<Border> in_y = {{0}, {surface.slit_y, true}, {1}};
  if (materials.across == TwoMembranes::Across::x) in_x.push_back({materials.border});
  if (materials.across == TwoMembranes::Across::y) in_y.push_back({materials.border});
  x_ = graded(std::move(in_x), cells);
  y_ = graded(std::move(in_y), cells);
  slit_row_ = 2 * line_of(y_, surface.slit_y);
  slit_first_ = 2 * line_of(x_, surface.slit_begin);
  slit_last_ = 2 * line_of(x_, surface.slit_end);
  const std::size_t count =
      (2 * x_.size() - 1) * (2 * y_.size() - 1) + (slit_last_ - slit_first_ - 1);

  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count), 3);
  for (std::size_t i = 0; i + 1 < x_.size(); ++i)
    for (std::size_t j = 0; j + 1 < y_.size(); ++j) {
      const bool is_above = 2 * j >= slit_row_;
      const auto matrix = cell_matrix(surface, materials, {x_[i], x_[i + 1]}, {y_[j], y_[j + 1]});
      const auto index = [&](std::size_t k) {
        return static_cast<Eigen::Index>(node(2 * i + k % 3, 2 * j + k / 3, is_above));
      };
      for (std::size_t k = 0; k < 9; ++k)
        for (std::size_t l = 0; l < 9; ++l)
          entries.emplace_back(index(k), index(l),
                               matrix(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)));
    }
  for (std::size_t i = slit_first_ / 2; i < slit_last_ / 2; ++i)
    for (std::size_t a = 0; a < 4; ++a) {
      const double half = 0.5 * (x_[i + 1] - x_[i]);
      const Vec3d pull = kGaussWeights[a] * half *
                         pull_at(surface, x_[i] + half * (1 + kGaussPlaces[a]), newtons_per_metre);
      const auto values = quadratics(kGaussPlaces[a]);
      for (std::size_t k = 0; k < 3; ++k)
        for (const bool is_above : {true, false})
          loads.row(static_cast<Eigen::Index>(node(2 * i + k, slit_row_, is_above))) +=
              (is_above ? values[k] : -values[k]) * pull.transpose();
    }
  Eigen::SparseMatrix<double> matrix(static_cast<Eigen::Index>(count),
                                     static_cast<Eigen::Index>(count));
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
  if (factors.info() != Eigen::Success) std::abort();
  const Eigen::MatrixXd found = factors.solve(loads);
  for (Eigen::Index p = 0; p < found.rows(); ++p)
    displacements_.emplace_back(found.row(p).transpose());
}

std::size_t QuadraticMembrane::node(std::size_t i, std::size_t j, bool is_above) const {
  const std::size_t columns = 2 * x_.size() - 1;
  if (is_above && j == slit_row_ && i > slit_first_ && i < slit_last_)
    return columns * (2 * y_.size() - 1) + (i - slit_first_ - 1);
  return columns * j + i;
}

Vec3d QuadraticMembrane::displacement(double x, double y, bool is_above) const {
  const std::size_t i = cell_of(x_, x, false), j = cell_of(y_, y, is_above);
  const auto place = [](const std::vector<double>& lines, std::size_t cell, double at) {
    return 2 * (at - lines[cell]) / (lines[cell + 1] - lines[cell]) - 1;
  };
  const auto fs = quadratics(place(x_, i, x)), ft = quadratics(place(y_, j, y));
  Vec3d sum = Vec3d::Zero();
  for (std::size_t k = 0; k < 9; ++k)
    sum += fs[k % 3] * ft[k / 3] *
           displacements_[node(2 * i + k % 3, 2 * j + k / 3, 2 * j >= slit_row_)];
  return sum;
}

double QuadraticMembrane::gap(double x) const {
  const double y = y_[slit_row_ / 2];
  return (displacement(x, y, true) - displacement(x, y, false)).norm();
}

double QuadraticMembrane::widest_gap() const {
  double widest = 0;
  constexpr int kPlaces = 16;  // of each cell: the widest one need not be on a line of the grid
  for (std::size_t i = slit_first_ / 2; i < slit_last_ / 2; ++i)
    for (int k = 0; k < kPlaces; ++k)
      widest = std::max(widest, gap(x_[i] + (x_[i + 1] - x_[i]) * k / kPlaces));
  return widest;
}

}  // namespace sunder::test
