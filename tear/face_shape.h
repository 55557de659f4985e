#pragma once

#include <sunder/core/math.h>

#include <algorithm>

namespace sunder::tear {

/// Least height over longest side, squared: 3/4 for an equilateral triangle, 0 for one without area.
inline double shape_squared(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  // Plain numbers: this is asked for each face that a tear crosses.
  struct Way {
    double x, y, z;
    [[nodiscard]] double squared() const { return x * x + y * y + z * z; }
  };
  const auto way = [](const Vec3f& from, const Vec3f& to) -> Way {
    return {static_cast<double>(to.x()) - static_cast<double>(from.x()),
            static_cast<double>(to.y()) - static_cast<double>(from.y()),
            static_cast<double>(to.z()) - static_cast<double>(from.z())};
  };
  const Way u = way(a, b), v = way(a, c);
  const double longest_squared = std::max({u.squared(), v.squared(), way(b, c).squared()});
  const Way normal{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  return longest_squared > 0 ? normal.squared() / (longest_squared * longest_squared) : 0.0;
}

/// Another diagonal has to be better by this part, so that rounding does not turn edges to and fro.
inline constexpr double kBetterShape = 1.0001;

}  // namespace sunder::tear
