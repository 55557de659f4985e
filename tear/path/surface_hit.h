#pragma once

#include <sunder/core/index.h>
#include <sunder/core/math.h>

#include <array>

namespace sunder::tear {

/// A place on the surface.
struct SurfaceHit {
  Index triangle = kNone;
  std::array<double, 3> barycentric = {};
  Vec3d position = Vec3d::Zero();  ///< Posed.
  /// For a contact: the progress at which the sweep leaves the triangle.
  double progress_beyond = 0;
};

}  // namespace sunder::tear
