#pragma once

#include <sunder/core/api.h>
#include <sunder/particles/collider.h>

#include <vector>

namespace sunder::particles {

/// The ball, capsule or box of least volume, along the principal axes of the points, around them.
/// @param points  at least one, finite.
[[nodiscard]] SUNDER_API Collider fitted_shape(std::vector<Vec3d> points, double friction);

}  // namespace sunder::particles
