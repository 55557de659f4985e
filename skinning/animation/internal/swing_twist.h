#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>

namespace sunder::animation {

/// A rotation as a twist about an axis, and then a swing of that axis by the shortest way.
struct SwingTwist {
  Quatd swing;         ///< Real part >= 0.
  double swing_angle;  ///< Radians, 0 to pi.
  double twist_angle;  ///< Radians, in (-2 pi, 2 pi].
};

/// @param rotation  unit quaternion. @param axis  unit length.
[[nodiscard]] SUNDER_API SwingTwist split_rotation(const Quatd& rotation, const Vec3d& axis);

/// The part of a rotation about a unit axis, as an angle in (-2 pi, 2 pi].
[[nodiscard]] SUNDER_API double twist_angle(const Quatd& rotation, const Vec3d& axis);

}  // namespace sunder::animation
