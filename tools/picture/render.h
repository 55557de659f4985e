#pragma once

#include <sunder/core/status.h>

#include <filesystem>

#include "tools/render/camera.h"

namespace sunder::tools {

/// Whether f3d and xvfb-run, which draw the pictures, are installed.
[[nodiscard]] bool can_draw();

/// Names the packages that can_draw() misses.
inline constexpr const char* kNoRenderer =
    "f3d and xvfb-run are not both installed (Debian: apt install f3d xvfb xauth)";

/// The name of the scene file of a picture, in the same folder.
[[nodiscard]] std::filesystem::path scene_file(const std::filesystem::path& png);

/// Draws a GLB into a PNG with f3d under Xvfb, and removes the GLB. Takes about a second.
[[nodiscard]] Status render(const std::filesystem::path& scene, const Camera& camera,
                            const PictureSize& size, const std::filesystem::path& png);

}  // namespace sunder::tools
