#include "pipeline/binding/stiffness.h"

#include <algorithm>
#include <tuple>

#include "core/internal/cotangent_stiffness.h"
#include "core/internal/ordered.h"

namespace sunder::binding {
namespace {

constexpr double kSmallestWeight = 1e-4, kLargestWeight = 1e3;
constexpr double kSmallestMass = 1e-6;  ///< Of the mean.

void add_face(const WeldedSurface& surface, Index face, std::vector<HalfCotangent>& halves,
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

}  // namespace

Stiffness make_stiffness(const WeldedSurface& surface) {
  Stiffness stiffness;
  const auto size = static_cast<Eigen::Index>(surface.positions.size());
  stiffness.matrix.resize(size, size);
  stiffness.mass.assign(surface.positions.size(), 0.0);
  std::vector<HalfCotangent> halves;
  halves.reserve(3 * surface.triangles.size());
  for (Index face = 0; face < surface.triangles.size(); ++face)
    add_face(surface, face, halves, stiffness.mass);
  std::tie(stiffness.edges, stiffness.clamped_edges) =
      add_cotangent_edges(halves, kSmallestWeight, kLargestWeight, stiffness.matrix);
  double total = 0;
  for (const double mass : stiffness.mass) total += mass;
  const double mean = size == 0 ? 0 : total / static_cast<double>(size);
  const double least = mean > 0 ? kSmallestMass * mean : 1;
  for (double& mass : stiffness.mass) mass = std::max(mass, least);
  return stiffness;
}

}  // namespace sunder::binding
