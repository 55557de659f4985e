#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>

namespace sunder::robot {

/// The axes along which a planar joint slides, for its unit normal: the joint's x and y axes after
/// the shortest turn that takes z to the normal; x and -y for the normal -z. Together with the
/// normal they are right-handed.
struct PlanarAxes {
  Vec3d x = Vec3d::UnitX(), y = Vec3d::UnitY();
};

[[nodiscard]] SUNDER_API PlanarAxes planar_axes(const Vec3d& normal);

}  // namespace sunder::robot
