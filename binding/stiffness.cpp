#include "binding/stiffness.h"

#include <algorithm>
#include <tuple>

#include "core/internal/ordered.h"

namespace sunder::binding {
namespace {

constexpr double kSmallestWeight = 1e-4, kLargestWeight = 1e3;
constexpr double kSmallestMass = 1e-6;  ///< Of the mean.

/// Half the cotangent at a corner, of the edge opposite to it (first < second).
struct HalfWeight {
  Index first, second;
  double value;
};

void add_face(const WeldedSurface& surface, Index face, std::vector<HalfWeight>& halves,
              std::vector<double>& mass) {
  const Triangle& triangle = surface.triangles[face];
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& at = surface.positions[triangle[k]];
    const Index b = triangle[(k + 1) % 3], c = triangle[(k + 2) % 3];
    const Vec3d to_b = surface.positions[b] - at, to_c = surface.positions[c] - at;
    const double twice_area = norm(to_b.cross(to_c));
    const double half_cotangent = surface.has_area[face] ? dot(to_b, to_c) / twice_area / 2 : 0.0;
    halves.push_back({std::min(b, c), std::max(b, c), half_cotangent});
    if (surface.has_area[face]) mass[triangle[k]] += twice_area / 6;
  }
}

void add_edges(std::vector<HalfWeight>& halves, Stiffness& stiffness) {
  // Equal sums in every order of the triangles.
  std::ranges::sort(halves, [](const HalfWeight& a, const HalfWeight& b) {
    return std::tie(a.first, a.second, a.value) < std::tie(b.first, b.second, b.value);
  });
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t begin = 0, end = 0; begin < halves.size(); begin = end) {
    double sum = 0;
    for (; end < halves.size() && halves[end].first == halves[begin].first &&
           halves[end].second == halves[begin].second;
         ++end)
      sum += halves[end].value;
    const double weight = std::clamp(sum, kSmallestWeight, kLargestWeight);
    ++stiffness.edges;
    if (weight != sum) ++stiffness.clamped_edges;
    const auto a = static_cast<int>(halves[begin].first),
               b = static_cast<int>(halves[begin].second);
    entries.insert(entries.end(),
                   {{a, b, -weight}, {b, a, -weight}, {a, a, weight}, {b, b, weight}});
  }
  stiffness.matrix.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace

Stiffness make_stiffness(const WeldedSurface& surface) {
  Stiffness stiffness;
  const auto size = static_cast<Eigen::Index>(surface.positions.size());
  stiffness.matrix.resize(size, size);
  stiffness.mass.assign(surface.positions.size(), 0.0);
  std::vector<HalfWeight> halves;
  halves.reserve(3 * surface.triangles.size());
  for (Index face = 0; face < surface.triangles.size(); ++face)
    add_face(surface, face, halves, stiffness.mass);
  add_edges(halves, stiffness);
  double total = 0;
  for (const double mass : stiffness.mass) total += mass;
  const double mean = size == 0 ? 0 : total / static_cast<double>(size);
  const double least = mean > 0 ? kSmallestMass * mean : 1;
  for (double& mass : stiffness.mass) mass = std::max(mass, least);
  return stiffness;
}

}  // namespace sunder::binding
