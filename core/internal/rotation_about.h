#pragma once

#include <sunder/core/math.h>

#include "core/internal/elementary.h"

namespace sunder {

/// The rotation by an angle in radians about a unit axis, with the same bits on every platform.
inline Quatd rotation_about(double angle, const Vec3d& axis) {
  const double sine = elementary::sin(0.5 * angle);
  return {elementary::cos(0.5 * angle), sine * axis.x(), sine * axis.y(), sine * axis.z()};
}

}  // namespace sunder
