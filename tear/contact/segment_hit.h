#pragma once

#include <sunder/core/math.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"

namespace sunder::tear {

/// Where a line meets a triangle.
struct SegmentHit {
  double along = 0;                               ///< From `base`, in units of `way`; >= 0.
  std::array<double, 3> barycentric = {1, 0, 0};  ///< >= 0, sum 1.
  bool enters = true;
};

/// The intersection of a half-line with a triangle, its edges included, so that it passes no gap
/// between two faces. Lines along the triangle's plane do not meet it. Moeller and Trumbore 1997.
[[nodiscard]] inline std::optional<SegmentHit> hit_of_segment(const Vec3d& base, const Vec3d& way,
                                                              const std::array<Vec3d, 3>& corners) {
  const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
  const Vec3d h = way.cross(ac);
  const double determinant = dot(ab, h);
  if (!(std::abs(determinant) > kAlongFaceLengths * norm(ab) * norm(ac) * norm(way)))
    return std::nullopt;
  const Vec3d from_corner = base - corners[0];
  const double u = dot(from_corner, h) / determinant;
  if (!(u >= -kHitBarycentric && u <= 1 + kHitBarycentric)) return std::nullopt;
  const Vec3d q = from_corner.cross(ab);
  const double v = dot(way, q) / determinant, along = dot(ac, q) / determinant;
  if (!(v >= -kHitBarycentric && u + v <= 1 + kHitBarycentric && along >= 0)) return std::nullopt;
  std::array<double, 3> barycentric = {std::max(0.0, 1 - u - v), std::max(0.0, u),
                                       std::max(0.0, v)};
  const double sum = barycentric[0] + barycentric[1] + barycentric[2];
  for (double& part : barycentric) part /= sum;
  return SegmentHit{along, barycentric, determinant > 0};
}

}  // namespace sunder::tear
