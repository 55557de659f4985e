#pragma once

#include "tools/render/camera.h"
#include "tools/render/png_file.h"
#include "tools/render/render_scene.h"

namespace sunder::tools {

/// Draws a scene by rays: light from the sky, which crevices get less of, and from a lamp above the
/// camera's left shoulder with soft shadows; then the marks. The same pixels on every machine with
/// the same floating-point results, and on any number of threads. Takes about a second of processor
/// time per 1280 x 960 pixels.
/// @param threads  0: as many as the machine has.
[[nodiscard]] Picture trace(const RenderScene& scene, const Camera& camera, const PictureSize& size,
                            unsigned threads = 0);

}  // namespace sunder::tools
