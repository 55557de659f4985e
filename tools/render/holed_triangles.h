#pragma once

#include <vector>

#include "tools/render/render_scene.h"

namespace sunder::tools {

/// Per triangle of a scene, whether light may pass it anywhere. It may not where all pixels of its
/// image that it shows are opaque, whatever its material says of alpha: most materials with cut-out
/// alpha have no hole on most triangles.
///
/// O(pixels of the images whose alpha counts + triangles).
[[nodiscard]] std::vector<bool> holed_triangles(const RenderScene& scene);

}  // namespace sunder::tools
