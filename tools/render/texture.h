#pragma once

#include <sunder/core/math.h>

#include <array>

#include "tools/render/render_scene.h"

namespace sunder::tools {

/// The linear value of each byte of an image in sRGB.
[[nodiscard]] const std::array<float, 256>& linear_from_srgb();

/// The mean of the four pixels of a material's image around a place, or the one there if the
/// material is pixelated, linear RGBA.
[[nodiscard]] Vec4f sampled(const Image& image, const RenderMaterial& material, const Vec2f& uv);

}  // namespace sunder::tools
