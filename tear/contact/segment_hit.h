#pragma once

#include <sunder/core/math.h>

#include <algorithm>
#include <array>
#include <optional>

#include "tear/geometry/triangle_crossing.h"

namespace sunder::tear {

/// Where a line meets a triangle.
struct SegmentHit {
  double along = 0;                               ///< From `base`, in units of `way`; >= 0.
  std::array<double, 3> barycentric = {1, 0, 0};  ///< >= 0, sum 1.
  bool enters = true;
};

/// The intersection of a half-line with a triangle.
[[nodiscard]] inline std::optional<SegmentHit> hit_of_segment(const Vec3d& base, const Vec3d& way,
                                                              const std::array<Vec3d, 3>& corners) {
  const auto crossing = cross_triangle(base, way, corners);
  if (!crossing || !(crossing->along >= 0)) return std::nullopt;
  const double u = crossing->u, v = crossing->v;
  std::array<double, 3> barycentric = {std::max(0.0, 1 - u - v), std::max(0.0, u),
                                       std::max(0.0, v)};
  const double sum = barycentric[0] + barycentric[1] + barycentric[2];
  for (double& part : barycentric) part /= sum;
  return SegmentHit{crossing->along, barycentric, crossing->enters};
}

}  // namespace sunder::tear
