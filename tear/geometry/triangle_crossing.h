#pragma once

#include <sunder/core/math.h>

#include <array>
#include <cmath>
#include <optional>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"

namespace sunder::tear {

/// Where a line crosses a triangle.
struct TriangleCrossing {
  double u = 0, v = 0;  ///< Barycentric coordinates of the second and the third corner.
  double along = 0;     ///< From `base`, in units of `way`.
  bool enters = true;   ///< From the side of the triangle's normal.

  [[nodiscard]] bool is_on_segment() const { return along >= 0 && along <= 1; }
};

/// The crossing of a line with a triangle, its edges included, so that it passes no gap between two
/// faces. Lines along the triangle's plane do not cross it. Moeller and Trumbore 1997.
[[nodiscard]] inline std::optional<TriangleCrossing> cross_triangle(
    const Vec3d& base, const Vec3d& way, const std::array<Vec3d, 3>& corners) {
  const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
  const Vec3d h = way.cross(ac);
  const double determinant = dot(ab, h);
  const Vec3d from_corner = base - corners[0];
  // Most triangles are missed beside their first edges; numbers that are not finite are found
  // below.
  const double u = dot(from_corner, h) / determinant;
  if (u < -kHitBarycentric || u > 1 + 4 * kHitBarycentric) return std::nullopt;
  const Vec3d q = from_corner.cross(ab);
  const double v = dot(way, q) / determinant;
  if (v < -kHitBarycentric || u + v > 1 + kHitBarycentric) return std::nullopt;
  if (!(std::abs(determinant) > kAlongFaceLengths * norm(ab) * norm(ac) * norm(way)))
    return std::nullopt;
  return TriangleCrossing{u, v, dot(ac, q) / determinant, determinant > 0};
}

}  // namespace sunder::tear
