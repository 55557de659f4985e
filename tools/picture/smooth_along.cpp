#include "tools/picture/smooth_along.h"

#include <algorithm>

namespace sunder::tools {

SmoothAlong::SmoothAlong(std::span<const Edge> edges, const std::vector<bool>& is_fixed,
                         float distance) {
  const auto count = static_cast<Eigen::Index>(is_fixed.size());
  held_.setZero(count);
  std::vector<Eigen::Triplet<double>> entries;
  // The implicit step of the heat equation after the time in which heat spreads over the distance:
  // each section has the length around it as mass, edges conduct as their length is short.
  const double square = static_cast<double>(distance) * static_cast<double>(distance);
  for (const Edge& edge : edges) {
    const auto length = static_cast<double>(std::max({edge.length, 1e-3f * distance, 1e-20f}));
    held_[edge.a] += length / 2;
    held_[edge.b] += length / 2;
    const double conducted = square / length;
    entries.emplace_back(edge.a, edge.a, conducted);
    entries.emplace_back(edge.b, edge.b, conducted);
    entries.emplace_back(edge.a, edge.b, -conducted);
    entries.emplace_back(edge.b, edge.a, -conducted);
  }
  for (Eigen::Index s = 0; s < count; ++s) {
    if (is_fixed[static_cast<std::size_t>(s)]) held_[s] += 1e9 * (held_[s] + square);
    if (!(held_[s] > 0)) held_[s] = 1;  // Of no edge.
    entries.emplace_back(s, s, held_[s]);
  }
  Eigen::SparseMatrix<double> system(count, count);
  system.setFromTriplets(entries.begin(), entries.end());
  factors_.compute(system);
}

Eigen::MatrixXd SmoothAlong::smoothed(const Eigen::MatrixXd& values) const {
  return factors_.solve(held_.asDiagonal() * values);
}

}  // namespace sunder::tools
