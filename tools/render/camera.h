#pragma once

#include <sunder/core/math.h>

namespace sunder::tools {

struct Camera {
  Vec3d eye, focal_point, up;
  double view_angle_degrees = 30;  ///< Vertical.
};

struct PictureSize {
  int width = 1280, height = 960;  ///< Pixels.
};

}  // namespace sunder::tools
