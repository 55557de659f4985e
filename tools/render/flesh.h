#pragma once

#include <sunder/core/math.h>

namespace sunder::tools {

/// The linear colour of the inside of a wound: pale skin at its lips, fat, muscle and blood below.
/// @param along   the wound, in units of its width.
/// @param across  0 at one lip, 1 at the other one; below -1: flesh alone, without lips.
[[nodiscard]] Vec3f flesh_color(float along, float across);

/// Smooth noise, 0 to 1, with features of the size 1.
[[nodiscard]] float noise(float x, float y);

}  // namespace sunder::tools
