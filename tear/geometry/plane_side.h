#pragma once

#include <sunder/core/math.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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

/// A line that is clipped by half-spaces one after the other.
struct ClippedLine {
  Vec3d begin, way;
  double first = 0, last = 1;  ///< The part that is left, in units of `way`.

  [[nodiscard]] Vec3d place(double at) const { return begin + at * way; }

  enum class Change : std::uint8_t { none, first, last, all };
  /// @return which end moved; `all`: nothing is left.
  Change clip(const PlaneSide& side) {
    const bool has_begin = side.contains(begin), has_end = side.contains(begin + way);
    if (has_begin && has_end) return Change::none;
    if (!has_begin && !has_end) return Change::all;
    const double at_begin = side.value(begin), at_end = side.value(begin + way);
    const double at =
        at_begin == at_end ? 0.0 : std::clamp(at_begin / (at_begin - at_end), 0.0, 1.0);
    if (!has_begin && at >= first) {
      first = at;
      return Change::first;
    }
    if (!has_end && at <= last) {
      last = at;
      return Change::last;
    }
    return Change::none;
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
