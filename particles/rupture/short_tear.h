#pragma once

#include <vector>

#include "particles/clusters/surface_pose.h"
#include "particles/rupture/tissue.h"

namespace sunder::particles {

/// Where a tear continues or begins.
struct TearStart {
  Index point = kNone;
  bool is_tip = false;
  std::array<Index, 2> particles = {};  ///< Around it: at a tip, those of the two lips.
};

/// A short straight tear on the posed surface.
struct ShortTear {
  Vec3d from = Vec3d::Zero();
  Vec3d direction = Vec3d::Zero();  ///< Unit length.
  Vec3d normal = Vec3d::Zero();     ///< Of the surface; zero if there is none.
};

/// Places a tear of the given length, metres, across the direction of the greatest stretch: forward
/// from a tip, or with its middle at another point.
[[nodiscard]] ShortTear place_tear(const Tissue& tissue, const SurfacePose& pose,
                                   const TearStart& start, double length);

}  // namespace sunder::particles
