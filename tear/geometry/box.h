#pragma once

#include <algorithm>
#include <array>

#include "core/internal/ordered.h"
#include "tear/geometry/plane_side.h"
#include "tear/geometry/tolerances.h"

namespace sunder::tear {

/// The coordinate frame of a query of the posed surface: with axes of its own and an origin near
/// the surface, so that float coordinates stay precise far from the model's origin.
struct Frame {
  Mat3d axes = Mat3d::Identity();  ///< Rows: orthogonal unit vectors.
  Vec3d origin = Vec3d::Zero();

  [[nodiscard]] Vec3d place_of(const Vec3d& point) const { return multiply(axes, point - origin); }
  /// The largest coordinate of the origin: coordinates of the model are rounded in proportion to
  /// it, in addition to those in the frame.
  [[nodiscard]] double reach() const { return origin.cwiseAbs().maxCoeff(); }
};

/// A box in a frame; infinite where no bound is known.
struct FrameBox {
  Vec3d low = Vec3d::Zero(), high = Vec3d::Zero();

  [[nodiscard]] Vec3d middle() const { return 0.5 * (low + high); }
  [[nodiscard]] Vec3d half_size() const { return 0.5 * (high - low); }
  /// Over all points of the box.
  [[nodiscard]] double largest_coordinate() const {
    return std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  }

  /// Upper bound of the distance by which rounding can move a point that is computed from the box'
  /// corners and from coordinates up to `reach`. The margin of a box inside another one is not
  /// greater.
  [[nodiscard]] double margin(double reach) const {
    return kBoxSizes * (high - low).maxCoeff() + kPosedCoordinates * (largest_coordinate() + reach);
  }
  [[nodiscard]] FrameBox widened(double reach) const {
    const Vec3d all_around = Vec3d::Constant(margin(reach));
    return {low - all_around, high + all_around};
  }
};

/// The projection of an object along the first of some axes: its range on that axis, and across it
/// three pairs of parallel lines, turned as the object is, that enclose it. The shadow of a long
/// object that lies askew is much smaller than the box around it.
struct Shadow {
  double low = 0, high = 0;  ///< Range on the first axis.
  std::array<Vec2d, 3> normal = {
      Vec2d::Zero(), Vec2d::Zero(),
      Vec2d::Zero()};              ///< Per pair of lines, on the second and third axis.
  std::array<double, 3> from, to;  ///< Per pair of lines: their offsets along the normal.
};

/// Orthogonal unit vectors as rows. The first is parallel to `first`; the second points towards
/// `second` as far as that differs from `first`.
[[nodiscard]] Mat3d axes_along(const Vec3d& first, const Vec3d& second = Vec3d::Zero());

/// A half-space in a frame.
class FramedPlaneSide {
 public:
  FramedPlaneSide(const Frame& frame, const PlaneSide& side)
      : inside_{multiply(frame.axes, side.normal), side.offset - dot(side.normal, frame.origin)},
        steepness_(inside_.normal.cwiseAbs()),
        magnitude_(std::abs(side.offset) + dot(side.normal.cwiseAbs(), frame.origin.cwiseAbs())) {}

  /// Whether the box is certainly outside the half-space, whatever rounding does to either.
  [[nodiscard]] bool is_beside(const FrameBox& box) const {
    const Vec3d middle = box.middle(), half = box.half_size();
    const double greatest = inside_.value(middle) + dot(steepness_, half);
    return greatest < -kPosedCoordinates * (magnitude_ + dot(steepness_, middle.cwiseAbs() + half));
  }

 private:
  PlaneSide inside_;
  Vec3d steepness_;
  double magnitude_;  ///< Sum of the magnitudes of the terms, in model space.
};

}  // namespace sunder::tear
