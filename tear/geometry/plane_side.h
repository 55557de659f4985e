#pragma once

#include <sunder/core/math.h>

#include <cmath>
#include <memory_resource>
#include <span>
#include <vector>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"

namespace sunder::tear {

/// One side of a plane in model space: normal . p >= offset.
struct PlaneSide {
  Vec3d normal = Vec3d::Zero();
  double offset = 0;

  /// Signed distance in metres if the normal is a unit vector.
  [[nodiscard]] double value(const Vec3d& point) const { return dot(normal, point) - offset; }
  /// Depends on the point alone, so that all faces agree about their common points. A point that
  /// rounding cannot tell from the plane is inside: a blade that lies in a face passes it and does
  /// not cut through it.
  [[nodiscard]] bool contains(const Vec3d& point) const { return value(point) >= -rounding(point); }
  /// The distance within which rounding cannot tell a point from the plane.
  [[nodiscard]] double rounding(const Vec3d& point) const {
    return kOnPlaneTerms * (std::abs(normal.x() * point.x()) + std::abs(normal.y() * point.y()) +
                            std::abs(normal.z() * point.z()) + std::abs(offset));
  }
};

/// The part of a plane that lies inside some half-spaces. Edges are made where it meets the
/// surface.
struct Sheet {
  /// A limit of the sheet. If it is another sheet of the same figure, the two meet in corners.
  struct Bound {
    PlaneSide side;
    std::uint32_t sheet = kNone;
  };
  PlaneSide plane;
  std::pmr::vector<Bound> bounds;
};

/// A convex cell: the intersection of its half-spaces.
using Cell = std::vector<PlaneSide>;

}  // namespace sunder::tear
