#pragma once

#include <sunder/aim/aim.h>

#include "pipeline/aim/limb.h"

namespace sunder::aim {

/// See find_facing().
[[nodiscard]] Result<Facing> facing_of(const Character& character);

/// A side of a character that faces `front`, as a direction towards the viewer.
[[nodiscard]] Vec3d side_direction(ViewSide side, const Vec3d& front);

/// The direction from which a limb is seen where no view is given: from the front, or from the left
/// if the bone points to the front or the back.
[[nodiscard]] Vec3d default_direction(const Limb& limb, const Vec3d& front);

}  // namespace sunder::aim
