#pragma once

#include <sunder/core/math.h>

namespace sunder::tools {

/// A place beside a wound.
struct BloodPlace {
  double distance = 0;         ///< To the nearest lip along the skin, metres; either sign.
  double reach = 0;            ///< Distance at which the last of the blood ends, metres; > 0.
  double flow = 0;             ///< How much blood has run there: 0 to 1.
  Vec3d rest = Vec3d::Zero();  ///< In bind space, in reaches: borders and clots depend on it.
};

/// How much of the surface is covered, 0 to 1: all of it at the lip, up to an uneven border.
[[nodiscard]] double blood_cover(const BloodPlace& at);

/// A colour, linear RGB, as a surface of this colour looks there: blood, dark in clots, and
/// reddened around. The same on every machine. From `reach` on, without flow, it is the colour
/// itself.
[[nodiscard]] Vec3f bloodied(const Vec3f& color, const BloodPlace& at);

}  // namespace sunder::tools
