#include "pipeline/validation/transfer/laplacian.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "core/internal/cotangent_stiffness.h"
#include "core/internal/ordered.h"

namespace sunder::validation {
namespace {

constexpr double kSmallestWeight = 0.01, kLargestWeight = 100;
constexpr double kSmallestMass = 1e-6;  ///< Of the mean.

struct Corners {
  std::array<double, 3> cotangent;
  std::array<double, 3> opposite_squared;  ///< Squared length of the edge opposite to a corner.
  double area;
};

Corners corners_of(std::span<const Vec3d> positions, const Triangle& triangle) {
  Corners corners{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& at = positions[triangle[k]];
    const Vec3d a = positions[triangle[(k + 1) % 3]] - at,
                b = positions[triangle[(k + 2) % 3]] - at;
    const double twice_area = norm(a.cross(b));
    corners.area = twice_area / 2;
    corners.cotangent[k] = dot(a, b) / twice_area;
    corners.opposite_squared[k] = squared_norm(b - a);
  }
  return corners;
}

/// Adds the area of a triangle to its points: Voronoi where no angle is obtuse.
void add_mass(const Triangle& triangle, const Corners& corners, std::vector<double>& mass) {
  const auto obtuse = std::ranges::find_if(corners.cotangent, [](double c) { return c < 0; });
  for (std::size_t k = 0; k < 3; ++k) {
    double& sum = mass[triangle[k]];
    if (obtuse == corners.cotangent.end()) {
      for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3})
        sum += corners.opposite_squared[other] * corners.cotangent[other] / 8;
    } else {
      const bool is_obtuse = obtuse - corners.cotangent.begin() == static_cast<std::ptrdiff_t>(k);
      sum += corners.area / (is_obtuse ? 2 : 4);
    }
  }
}

}  // namespace

Laplacian make_laplacian(std::span<const Vec3d> positions, std::span<const Triangle> triangles) {
  Laplacian laplacian;
  laplacian.mass.assign(positions.size(), 0.0);
  std::vector<HalfCotangent> halves;
  halves.reserve(3 * triangles.size());
  for (const Triangle& triangle : triangles) {
    const Corners corners = corners_of(positions, triangle);
    add_mass(triangle, corners, laplacian.mass);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangle[(k + 1) % 3], triangle[(k + 2) % 3]);
      if (a != b) halves.push_back({a, b, corners.cotangent[k] / 2});
    }
  }
  const auto size = static_cast<Eigen::Index>(positions.size());
  laplacian.stiffness.resize(size, size);
  std::tie(laplacian.edges, laplacian.clamped_edges) =
      add_cotangent_edges(halves, kSmallestWeight, kLargestWeight, laplacian.stiffness);
  double total = 0;
  for (const double mass : laplacian.mass) total += mass;
  const double least =
      positions.empty() ? 0 : kSmallestMass * total / static_cast<double>(positions.size());
  for (double& mass : laplacian.mass) {
    if (mass >= least) continue;
    mass = least;
    ++laplacian.floored_points;
  }
  return laplacian;
}

}  // namespace sunder::validation
