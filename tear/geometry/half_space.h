#pragma once

#include <sunder/core/math.h>

#include <cmath>
#include <span>
#include <vector>

namespace sunder::tear {

/// One side of a plane in model space: normal . p >= offset.
struct HalfSpace {
  Vec3d normal = Vec3d::Zero();
  double offset = 0;

  /// Metres where the normal is a unit vector.
  [[nodiscard]] double value(const Vec3d& point) const { return normal.dot(point) - offset; }
  /// A function of the point alone, so that all faces agree about their common points. What
  /// rounding cannot tell from the plane is inside: a blade that lies in a face passes beside it
  /// and not through it.
  [[nodiscard]] bool contains(const Vec3d& point) const {
    const double rounding = std::abs(normal.x() * point.x()) + std::abs(normal.y() * point.y()) +
                            std::abs(normal.z() * point.z()) + std::abs(offset);
    return value(point) >= -2e-15 * rounding;
  }
};

/// The part of a plane that lies inside some half-spaces: where it meets the surface, edges are to
/// run.
struct Sheet {
  /// A limit of the sheet; where that is another sheet of the same figure, the two meet in corners.
  struct Bound {
    HalfSpace half_space;
    std::uint32_t sheet = kNone;
  };
  HalfSpace plane;
  std::vector<Bound> bounds;
};

/// A convex cell: the inside of all its half-spaces.
using Cell = std::vector<HalfSpace>;

}  // namespace sunder::tear
