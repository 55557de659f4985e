#pragma once

#include "tools/render/camera.h"
#include "tools/render/png_file.h"
#include "tools/render/render_scene.h"

namespace sunder::tools {

/// Draws a scene by rays: light from the sky, which crevices get less of, and from a lamp above the
/// camera's left shoulder with soft shadows. The same pixels on every machine with the same
/// floating-point results, and on any number of threads. Takes seconds.
[[nodiscard]] Picture trace(const RenderScene& scene, const Camera& camera,
                            const PictureSize& size);

}  // namespace sunder::tools
