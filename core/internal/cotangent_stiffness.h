#pragma once

#include <sunder/core/index.h>

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/SparseCore>

namespace sunder {

/// Half the cotangent at a corner of a triangle, of the edge opposite to it (first < second).
struct HalfCotangent {
  Index first, second;
  double value;
};

/// Sums the halves of each edge, clamps the sums and enters them into minus the cotangent
/// Laplacian: symmetric, rows sum to zero.
/// @param halves  are sorted, so that sums are equal in every order of the triangles.
/// @param matrix  points x points.
/// @return the number of edges, and of those whose sum was clamped.
template <class Matrix>
std::pair<Index, Index> add_cotangent_edges(std::vector<HalfCotangent>& halves, double least,
                                            double most, Matrix& matrix) {
  std::ranges::sort(halves, [](const HalfCotangent& a, const HalfCotangent& b) {
    return std::tie(a.first, a.second, a.value) < std::tie(b.first, b.second, b.value);
  });
  Index edges = 0, clamped = 0;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t begin = 0, end = 0; begin < halves.size(); begin = end) {
    double sum = 0;
    for (; end < halves.size() && halves[end].first == halves[begin].first &&
           halves[end].second == halves[begin].second;
         ++end)
      sum += halves[end].value;
    const double weight = std::clamp(sum, least, most);
    ++edges;
    if (weight != sum) ++clamped;
    const auto a = static_cast<int>(halves[begin].first),
               b = static_cast<int>(halves[begin].second);
    entries.insert(entries.end(),
                   {{a, b, -weight}, {b, a, -weight}, {a, a, weight}, {b, b, weight}});
  }
  matrix.setFromTriplets(entries.begin(), entries.end());
  return {edges, clamped};
}

}  // namespace sunder
