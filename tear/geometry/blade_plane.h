#pragma once

#include <sunder/operation/operation.h>

#include <array>
#include <optional>

#include "tear/geometry/box.h"

namespace sunder::tear {

/// Where a point lies in the sweep of a blade.
struct SweepCoordinates {
  double progress = 0;  ///< 0 under the first blade, 1 under the second.
  double depth = 0;     ///< 0 at the blade's base, 1 at its tip.
};

/// One segment of a stroke as a plane figure: the plane through the second blade and the point
/// where the tear stands, and in it the quadrilateral that the blade sweeps. Plane coordinates: x
/// across the second blade, zero on it and negative before it; y along it from its base.
class BladePlane {
 public:
  /// @param anchor  where the segment starts: the tip of the tear, or where the first blade meets
  /// the surface.
  /// @return nothing where the anchor lies on the second blade: the blade did not move.
  static std::optional<BladePlane> through(const Vec3d& anchor, const Blade& from, const Blade& to);

  /// Signed distance from the plane, metres.
  [[nodiscard]] double distance(const Vec3d& point) const { return normal_.dot(point - origin_); }
  [[nodiscard]] Vec2d project(const Vec3d& point) const {
    return {across_.dot(point - origin_), along_.dot(point - origin_)};
  }
  [[nodiscard]] SweepCoordinates sweep_coordinates(const Vec2d& point) const;
  /// Their progress alone.
  [[nodiscard]] double progress(const Vec2d& point) const;
  [[nodiscard]] double progress(const Vec3d& point) const { return progress(project(point)); }

  /// A half-plane of the plane figure: value(p) = normal . p - offset >= 0 inside.
  struct HalfPlane {
    Vec2d normal = Vec2d::Zero();
    double offset = 0;
    [[nodiscard]] double value(const Vec2d& point) const { return normal.dot(point) - offset; }
  };
  /// What the blade reaches: below its base, above its tip, before the second blade.
  [[nodiscard]] const std::array<HalfPlane, 3>& reach() const { return reach_; }
  /// What the blade sweeps from `progress` on.
  [[nodiscard]] HalfPlane from_progress(double progress) const;
  /// What it sweeps from the first blade on.
  [[nodiscard]] const HalfPlane& not_before() const { return not_before_; }

  /// A point of the plane: the second blade's base.
  [[nodiscard]] const Vec3d& origin() const { return origin_; }
  /// Rows: along, across, normal.
  [[nodiscard]] Mat3d axes() const;
  /// No point of a box, given along axes() from the origin, that lies in the plane and within reach
  /// has less progress than this. Minus infinity where that is not known.
  [[nodiscard]] double least_progress(const Box& box) const;

  /// Towards the left of the stroke, seen from where the blade comes; across the second blade,
  /// forwards; along it, from base to tip.
  [[nodiscard]] const Vec3d& normal() const { return normal_; }
  [[nodiscard]] const Vec3d& across() const { return across_; }
  [[nodiscard]] const Vec3d& along() const { return along_; }
  /// The half-space that stands on a half-plane of the figure, at right angles to the plane.
  [[nodiscard]] HalfSpace standing_on(const HalfPlane& half_plane) const {
    const Vec3d normal = half_plane.normal.x() * across_ + half_plane.normal.y() * along_;
    return {normal, half_plane.offset + normal.dot(origin_)};
  }
  /// What lies left of the plane moved by `distance` to its left.
  [[nodiscard]] HalfSpace left_of(double distance) const {
    return {normal_, normal_.dot(origin_) + distance};
  }
  [[nodiscard]] HalfSpace right_of(double distance) const {
    return {-normal_, -(normal_.dot(origin_) + distance)};
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
