#pragma once

#include <sunder/core/math.h>

#include <span>
#include <vector>

#include "tools/render/render_scene.h"

namespace sunder::tools {

/// A part of a picture whose samples marks are laid upon.
struct SampledPart {
  int left = 0, top = 0, width = 0, height = 0;  ///< Pixels.
  std::span<const Vec2d> places;                 ///< Of the samples in each pixel, 0 to 1.
  std::vector<Vec3f> colors;                     ///< Per pixel, row by row, and sample; linear RGB.
  std::vector<float> depths;                     ///< The same; of what is visible, metres.
};

/// Lays marks over the samples: first those in the scene, from the farthest to the nearest, then
/// those on top in their order.
void lay_marks(std::span<const RenderMark> marks, SampledPart& part);

}  // namespace sunder::tools
