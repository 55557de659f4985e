#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>

#include "core/internal/ordered.h"
#include "tear/section/flat_section.h"

namespace sunder::tear {

namespace {

/// The weight of an edge in the cotangent Laplacian, or a part of it.
struct EdgeWeight {
  Index low, high;
  double value;
};

/// The cotangent of each angle opposite to an edge that is not on the rim, ordered by edges.
std::vector<EdgeWeight> cotangents(std::span<const Vec2d> points, Index rim_count,
                                   std::span<const std::array<Index, 3>> triangles) {
  std::vector<EdgeWeight> weights;
  for (const auto& triangle : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = triangle[i], b = triangle[(i + 1) % 3];
      if (a < rim_count && b < rim_count) continue;
      const Vec2d to_a = points[a] - points[triangle[(i + 2) % 3]],
                  to_b = points[b] - points[triangle[(i + 2) % 3]];
      const double twice_area = to_a.x() * to_b.y() - to_a.y() * to_b.x();
      if (twice_area > 0)
        weights.push_back({std::min(a, b), std::max(a, b), dot(to_a, to_b) / twice_area});
    }
  // Stable, so that the order of summation is the same with every standard library.
  std::stable_sort(weights.begin(), weights.end(), [](const EdgeWeight& a, const EdgeWeight& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  return weights;
}

}  // namespace

Eigen::MatrixXd extend_harmonically(std::span<const Vec2d> points, Index rim_count,
                                    std::span<const std::array<Index, 3>> triangles,
                                    const Eigen::MatrixXd& rim_values) {
  const std::vector<EdgeWeight> weights = cotangents(points, rim_count, triangles);
  const auto inner_count = static_cast<Eigen::Index>(points.size() - rim_count);
  const Eigen::Index channels = rim_values.cols();
  if (inner_count == 0 || rim_count == 0) return Eigen::MatrixXd::Zero(inner_count, channels);
  Eigen::RowVectorXd least = rim_values.row(0), greatest = least;
  for (Eigen::Index i = 1; i < rim_values.rows(); ++i) {
    least = least.cwiseMin(rim_values.row(i));
    greatest = greatest.cwiseMax(rim_values.row(i));
  }
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(inner_count);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(inner_count, channels);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < weights.size();) {
    const Index low = weights[i].low, high = weights[i].high;
    double weight = 0;
    for (; i < weights.size() && weights[i].low == low && weights[i].high == high; ++i)
      weight += weights[i].value;
    if (!(weight > 0) || !std::isfinite(weight))
      continue;  // zero except for rounding: the four points lie on a circle
    const auto column = static_cast<Eigen::Index>(high - rim_count);
    diagonal[column] += weight;
    if (low < rim_count) {
      // Relative to the least value, because a common offset would only cost precision.
      right.row(column) += weight * (rim_values.row(low) - least);
    } else {
      const auto row = static_cast<Eigen::Index>(low - rim_count);
      diagonal[row] += weight;
      entries.emplace_back(row, column, -weight);
      entries.emplace_back(column, row, -weight);
    }
  }
  for (Eigen::Index i = 0; i < inner_count; ++i) entries.emplace_back(i, i, diagonal[i]);
  Eigen::SparseMatrix<double> laplacian(inner_count, inner_count);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(laplacian);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(inner_count, channels);
  if (factors.info() == Eigen::Success) result = factors.solve(right);

  for (Eigen::Index channel = 0; channel < channels; ++channel)
    for (Eigen::Index i = 0; i < inner_count; ++i) {
      double& value = result(i, channel);
      value = std::clamp(std::isfinite(value) ? least[channel] + value : least[channel],
                         least[channel], greatest[channel]);
    }
  return result;
}

}  // namespace sunder::tear
