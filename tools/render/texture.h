#pragma once

#include <sunder/core/math.h>

#include "tools/render/render_scene.h"

namespace sunder::tools {

/// The mean of the four pixels of an image around a place, linear RGBA.
[[nodiscard]] Vec4f sampled(const Image& image, const std::array<RenderMaterial::Wrap, 2>& wrap,
                            const Vec2f& uv);

}  // namespace sunder::tools
