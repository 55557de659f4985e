#pragma once

#include <sunder/tear/torn_model.h>

#include <array>

#include "support/models/solids.h"

namespace sunder::test {

/// A rigid character of one bone at the origin.
Character character_of(const Solid& body);

/// The bind surface of a torn rigid character, divided by a plane: below it, above it. A connected
/// component is on the side of its vertex that is farthest from the plane. Vertices are the
/// kernel's points.
std::array<Solid, 2> sides_of(const TornModel& model, const Vec3d& point, const Vec3d& normal);

}  // namespace sunder::test
