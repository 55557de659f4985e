#pragma once

#include "tools/render/camera.h"

namespace sunder::tools {

/// The rays from the eye to a picture.
struct RenderView {
  PictureSize size;
  /// `right` and `up`: half of the picture's width and height at the distance of one `forward`.
  Vec3f eye, right, up, forward;

  /// A ray through a place of the picture in pixels; a length of it is one of `forward`.
  [[nodiscard]] Vec3f along(double x, double y) const {
    return forward + static_cast<float>(2 * x / size.width - 1) * right + height(y) * up;
  }
  /// Converts a place in pixels: -1 at the lower edge, 1 at the upper one.
  [[nodiscard]] float height(double y) const { return static_cast<float>(1 - 2 * y / size.height); }
};

}  // namespace sunder::tools
