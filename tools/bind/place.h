#pragma once

#include <sunder/core/math.h>

#include <optional>
#include <string>

namespace sunder::tools {

/// Reads "x,y,z", "x,y,z,roll,pitch,yaw" or "x,y,z,roll,pitch,yaw,scale": metres and degrees, or
/// with units. A
/// place scales first, turns about the fixed x, y and z axes next, as in URDF, and then moves.
/// @return nothing for other texts, numbers beyond 1e9, and a scale that is not above 0.
[[nodiscard]] std::optional<Affine3d> parse_place(const std::string& text);

}  // namespace sunder::tools
