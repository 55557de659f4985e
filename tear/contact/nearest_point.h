#pragma once

#include <sunder/core/math.h>

#include <array>

namespace sunder::tear {

using Corners = std::array<Vec3d, 3>;

/// The nearest places of a triangle and of a point or segment.
struct NearestPlaces {
  double squared_distance = 0;
  std::array<double, 3> barycentric = {1, 0, 0};  ///< In the triangle; exactly 0 on an edge.
  double along = 0;                               ///< On the segment, 0 to 1.
};

/// Triangles without area count as their edges.
[[nodiscard]] NearestPlaces nearest_of_point(const Vec3d& point, const Corners& corners);
[[nodiscard]] NearestPlaces nearest_of_segment(const Vec3d& base, const Vec3d& tip,
                                               const Corners& corners);
/// The distance of two triangles that do not cross, squared.
[[nodiscard]] double squared_distance(const Corners& a, const Corners& b);

}  // namespace sunder::tear
