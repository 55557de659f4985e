#pragma once

#include <sunder/core/math.h>

#include <algorithm>

#include "core/internal/ordered.h"

namespace sunder::tear {

/// A place or a direction in bind space. Plain numbers, because this runs for each face that a tear
/// crosses.
struct Place {
  double x = 0, y = 0, z = 0;
};

inline Place place_of(const Vec3f& at) {
  return {static_cast<double>(at.x()), static_cast<double>(at.y()), static_cast<double>(at.z())};
}
inline Place way(const Place& from, const Place& to) {
  return {to.x - from.x, to.y - from.y, to.z - from.z};
}
using sunder::dot;  // of Eigen's vectors: the next one would hide it
inline double dot(const Place& a, const Place& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Normal of a triangle; its length is twice the area.
inline Place normal(const Place& a, const Place& b, const Place& c) {
  const Place u = way(a, b), v = way(a, c);
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

/// Least height over longest side, squared: 3/4 for an equilateral triangle, 0 for one without
/// area.
inline double shape_squared(const Place& a, const Place& b, const Place& c, const Place& normal) {
  const Place u = way(a, b), v = way(a, c), w = way(b, c);
  const double longest_squared = std::max({dot(u, u), dot(v, v), dot(w, w)});
  return longest_squared > 0 ? dot(normal, normal) / (longest_squared * longest_squared) : 0.0;
}
inline double shape_squared(const Place& a, const Place& b, const Place& c) {
  return shape_squared(a, b, c, normal(a, b, c));
}

}  // namespace sunder::tear
