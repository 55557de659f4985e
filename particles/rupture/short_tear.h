#pragma once

#include <vector>

#include "particles/clusters/surface_pose.h"
#include "particles/rupture/perforations.h"
#include "particles/rupture/tissue.h"

namespace sunder::particles {

/// Where a tear continues or begins.
struct TearStart {
  Index point = kNone;
  bool is_tip = false;
  std::array<Index, 2> particles = {};  ///< Around it: at a tip, those of the two lips.
  Course course = {};                   ///< Along a perforation, if there is one.
};

/// A short tear on the posed surface, straight unless it follows a perforation.
struct ShortTear {
  Vec3d from = Vec3d::Zero();
  Vec3d direction = Vec3d::Zero();  ///< Unit length.
  Vec3d normal = Vec3d::Zero();     ///< Of the surface; zero if there is none.
  double length = 0;                ///< Metres.
  /// If it follows a perforation: the places after `from`, and the surface's normals there.
  std::vector<std::pair<Vec3d, Vec3d>> path = {};
};

/// The direction in which the tissue around some particles is stretched most, in the plane
/// perpendicular to `normal`, along the axes of model space.
[[nodiscard]] Vec3d greatest_stretch_around(const Tissue& tissue,
                                            const std::array<Index, 2>& particles,
                                            const Vec3d& normal);

/// Places a tear of the given length, metres, across the direction of the greatest stretch: forward
/// from a tip, or with its middle at another point; or along a course of its own length.
[[nodiscard]] ShortTear place_tear(const Tissue& tissue, const SurfacePose& pose,
                                   const TearStart& start, double length);

}  // namespace sunder::particles
