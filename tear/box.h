#pragma once

#include <algorithm>

#include "tear/half_space.h"

namespace sunder::tear {

/// A box along some axes; infinite where nothing is known.
struct Box {
  Vec3d low = Vec3d::Zero(), high = Vec3d::Zero();

  [[nodiscard]] Vec3d middle() const { return 0.5 * (low + high); }
  [[nodiscard]] Vec3d half_size() const { return 0.5 * (high - low); }
  /// Of all its points.
  [[nodiscard]] double largest_coordinate() const { return std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()); }

  /// The box, wider by more than rounding can move a point that is computed from its corners and from coordinates up to `reach`.
  /// A box inside another one stays inside it.
  [[nodiscard]] Box widened(double reach) const {
    const double margin = 1e-9 * (high - low).maxCoeff() + 1e-12 * (largest_coordinate() + reach);
    const Vec3d all_around = Vec3d::Constant(margin);
    return {low - all_around, high + all_around};
  }
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
