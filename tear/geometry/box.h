#pragma once

#include <algorithm>
#include <array>

#include "tear/geometry/half_space.h"

namespace sunder::tear {

/// Coordinates in which a query looks at the posed surface: along its own axes, from a place near
/// the surface, so that far from the model's origin nothing is lost in float.
struct Frame {
  Mat3d axes = Mat3d::Identity();  ///< Rows: orthogonal unit vectors.
  Vec3d origin = Vec3d::Zero();

  [[nodiscard]] Vec3d place_of(const Vec3d& point) const { return axes * (point - origin); }
  /// What coordinates of the model are rounded by, besides those in the frame.
  [[nodiscard]] double reach() const { return origin.cwiseAbs().maxCoeff(); }
};

/// A box in a frame; infinite where nothing is known.
struct Box {
  Vec3d low = Vec3d::Zero(), high = Vec3d::Zero();

  [[nodiscard]] Vec3d middle() const { return 0.5 * (low + high); }
  [[nodiscard]] Vec3d half_size() const { return 0.5 * (high - low); }
  /// Of all its points.
  [[nodiscard]] double largest_coordinate() const {
    return std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  }

  /// More than rounding can move a point that is computed from the box' corners and from
  /// coordinates up to `reach`. That of a box inside another one is not greater.
  [[nodiscard]] double margin(double reach) const {
    return 1e-9 * (high - low).maxCoeff() + 1e-12 * (largest_coordinate() + reach);
  }
  [[nodiscard]] Box widened(double reach) const {
    const Vec3d all_around = Vec3d::Constant(margin(reach));
    return {low - all_around, high + all_around};
  }
};

/// What a thing looks like along the first of some axes: where it lies on it, and where between
/// three pairs of parallels across it, which are turned as the thing is. The shadow of a long thing
/// that lies askew is much smaller than the box around it.
struct Shadow {
  double low = 0, high = 0;  ///< Along the first axis.
  std::array<Vec2d, 3> normal = {
      Vec2d::Zero(), Vec2d::Zero(),
      Vec2d::Zero()};              ///< Of each pair of parallels, in the second and third axis.
  std::array<double, 3> from, to;  ///< Where they are.
};

/// Orthogonal unit vectors as rows: along `first`, then towards `second` as far as it goes another
/// way.
[[nodiscard]] Mat3d axes_along(const Vec3d& first, const Vec3d& second = Vec3d::Zero());

/// A half-space in a frame.
class FramedHalfSpace {
 public:
  FramedHalfSpace(const Frame& frame, const HalfSpace& half_space)
      : inside_{frame.axes * half_space.normal,
                half_space.offset - half_space.normal.dot(frame.origin)},
        steepness_(inside_.normal.cwiseAbs()),
        magnitude_(std::abs(half_space.offset) +
                   half_space.normal.cwiseAbs().dot(frame.origin.cwiseAbs())) {}

  /// Whether no point of a box can be found in it, whatever rounding does to either.
  [[nodiscard]] bool is_beside(const Box& box) const {
    const Vec3d middle = box.middle(), half = box.half_size();
    const double greatest = inside_.value(middle) + steepness_.dot(half);
    return greatest < -1e-12 * (magnitude_ + steepness_.dot(middle.cwiseAbs() + half));
  }

 private:
  HalfSpace inside_;
  Vec3d steepness_;
  double magnitude_;  ///< Of what was added up, in the model.
};

}  // namespace sunder::tear
