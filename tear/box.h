#pragma once

#include <algorithm>
#include <array>

#include "tear/half_space.h"

namespace sunder::tear {

/// A box along some axes; infinite where nothing is known.
struct Box {
  Vec3d low = Vec3d::Zero(), high = Vec3d::Zero();

  [[nodiscard]] Vec3d middle() const { return 0.5 * (low + high); }
  [[nodiscard]] Vec3d half_size() const { return 0.5 * (high - low); }
  /// Of all its points.
  [[nodiscard]] double largest_coordinate() const { return std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()); }

  /// More than rounding can move a point that is computed from the box' corners and from coordinates up to `reach`. That of a box
  /// inside another one is not greater.
  [[nodiscard]] double margin(double reach) const {
    return 1e-9 * (high - low).maxCoeff() + 1e-12 * (largest_coordinate() + reach);
  }
  [[nodiscard]] Box widened(double reach) const {
    const Vec3d all_around = Vec3d::Constant(margin(reach));
    return {low - all_around, high + all_around};
  }
};

/// What a thing looks like along the first of some axes: where it lies on it, and where between three pairs of parallels across it,
/// which are turned as the thing is. The shadow of a long thing that lies askew is much smaller than the box around it.
struct Shadow {
  double low = 0, high = 0;        ///< Along the first axis.
  std::array<Vec2d, 3> normal;     ///< Of each pair of parallels, in the second and third axis.
  std::array<double, 3> from, to;  ///< Where they are.
};

/// Orthogonal unit vectors as rows: along `first`, then towards `second` as far as it goes another way.
[[nodiscard]] Mat3d axes_along(const Vec3d& first, const Vec3d& second = Vec3d::Zero());

/// A half-space in the coordinates along some axes.
[[nodiscard]] inline HalfSpace in_axes(const Mat3d& axes, const HalfSpace& half_space) {
  return {axes * half_space.normal, half_space.offset};
}

/// Whether no point of a box can be found in a half-space, whatever rounding does to either.
[[nodiscard]] inline bool is_outside(const HalfSpace& half_space, const Box& box) {
  const Vec3d middle = box.middle(), half = box.half_size(), steepness = half_space.normal.cwiseAbs();
  const double greatest = half_space.value(middle) + steepness.dot(half);
  const double magnitude = steepness.dot(middle.cwiseAbs() + half) + std::abs(half_space.offset);
  return greatest < -1e-12 * magnitude;
}

}  // namespace sunder::tear
