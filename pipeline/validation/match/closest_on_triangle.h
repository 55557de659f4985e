#pragma once

#include <sunder/core/math.h>

#include <array>

namespace sunder::validation {

/// A place on a triangle and its distance from the point that it is closest to.
struct PlaceOnTriangle {
  std::array<double, 3> barycentric = {1.0, 0, 0};  ///< >= 0, sum 1.
  double distance = 0;
};

/// The closest place on a triangle with an area, by the region of its plane in which the point
/// lies. Source: Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
[[nodiscard]] PlaceOnTriangle closest_on_triangle(const Vec3d& point, const Vec3d& a,
                                                  const Vec3d& b, const Vec3d& c);

}  // namespace sunder::validation
