#pragma once

#include <sunder/core/math.h>

#include <vector>

namespace sunder {

/// One sample of a blade, model space, metres: a straight edge that reaches from the handle to the point.
struct Blade {
  Vec3d base = Vec3d::Zero();  ///< Outside the surface.
  Vec3d tip = Vec3d::Zero();   ///< How deep the blade reaches.

  bool operator==(const Blade&) const = default;
};

/// Successive blade positions; each two neighbours sweep one segment.
using Stroke = std::vector<Blade>;

}  // namespace sunder
