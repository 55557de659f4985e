#pragma once

#include <sunder/operation/operation.h>

#include <array>
#include <optional>

#include "core/internal/ordered.h"
#include "tear/geometry/box.h"

namespace sunder::tear {

/// Position of a point in the sweep of a blade.
struct SweepCoordinates {
  double progress = 0;  ///< 0 under the first blade, 1 under the second.
  double depth = 0;     ///< 0 at the blade's base, 1 at its tip.
};

/// One segment of a stroke as a plane figure: the plane through the second blade and the tip of the
/// tear, and in it the quadrilateral that the blade sweeps. Plane coordinates: x is across the
/// second blade, zero on it and negative before it; y is along it from its base.
class BladePlane {
 public:
  /// @param anchor  the start of the segment: the tip of the tear, or the point where the first
  /// blade meets the surface.
  /// @return nothing if the anchor lies on the second blade: the blade did not move.
  static std::optional<BladePlane> through(const Vec3d& anchor, const Blade& from, const Blade& to);

  /// Signed distance from the plane, metres.
  [[nodiscard]] double distance(const Vec3d& point) const { return dot(normal_, point - origin_); }
  [[nodiscard]] Vec2d project(const Vec3d& point) const {
    return {dot(across_, point - origin_), dot(along_, point - origin_)};
  }
  [[nodiscard]] SweepCoordinates sweep_coordinates(const Vec2d& point) const;
  /// Only the progress of sweep_coordinates().
  [[nodiscard]] double progress(const Vec2d& point) const;
  [[nodiscard]] double progress(const Vec3d& point) const { return progress(project(point)); }

  /// A half-plane of the plane figure: value(p) = normal . p - offset >= 0 inside.
  struct HalfPlane {
    Vec2d normal = Vec2d::Zero();
    double offset = 0;
    [[nodiscard]] double value(const Vec2d& point) const { return dot(normal, point) - offset; }
  };
  /// The half-planes that bound the blade's reach: below its base, above its tip, before the second
  /// blade.
  [[nodiscard]] const std::array<HalfPlane, 3>& reach() const { return reach_; }
  /// The half-plane that the blade sweeps from `progress` on.
  [[nodiscard]] HalfPlane from_progress(double progress) const;
  /// The half-plane that it sweeps from the first blade on.
  [[nodiscard]] const HalfPlane& not_before() const { return not_before_; }

  /// A point of the plane: the second blade's base.
  [[nodiscard]] const Vec3d& origin() const { return origin_; }
  /// Rows: along, across, normal.
  [[nodiscard]] Mat3d axes() const;
  /// Lower bound of the progress of all points of a box that lie in the plane and within reach;
  /// minus infinity where none is known. The box is given along axes() from the origin.
  [[nodiscard]] double least_progress(const FrameBox& box) const;

  /// Unit vectors. The normal points to the left of the stroke, seen from where the blade comes;
  /// `across` points forwards across the second blade, `along` from its base to its tip.
  [[nodiscard]] const Vec3d& normal() const { return normal_; }
  [[nodiscard]] const Vec3d& across() const { return across_; }
  [[nodiscard]] const Vec3d& along() const { return along_; }
  /// The half-space that stands on a half-plane of the figure, at right angles to the plane.
  [[nodiscard]] PlaneSide standing_on(const HalfPlane& half_plane) const {
    const Vec3d normal = half_plane.normal.x() * across_ + half_plane.normal.y() * along_;
    return {normal, half_plane.offset + dot(normal, origin_)};
  }
  /// The half-spaces on both sides of the plane after it is moved to its left by `distance`.
  [[nodiscard]] PlaneSide left_of(double distance) const {
    return {normal_, dot(normal_, origin_) + distance};
  }
  [[nodiscard]] PlaneSide right_of(double distance) const {
    return {-normal_, -(dot(normal_, origin_) + distance)};
  }

 private:
  Vec3d origin_, across_, along_, normal_;
  Vec2d from_base_, from_tip_, to_base_, to_tip_;
  // The blade at progress s: base e s + from_base, direction d + g s.
  Vec2d e_, d_, g_;
  double a_ = 0, cross_e_d_ = 0;
  std::array<HalfPlane, 3> reach_;
  HalfPlane not_before_;
};

}  // namespace sunder::tear
