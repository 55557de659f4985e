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

/// A new folder for the files of one drawing, which only the user can read. It is removed with all
/// its files at the end of the scope, so that no other file is ever touched.
class DrawingFolder {
 public:
  DrawingFolder();
  ~DrawingFolder();
  DrawingFolder(const DrawingFolder&) = delete;
  DrawingFolder& operator=(const DrawingFolder&) = delete;

  [[nodiscard]] bool exists() const { return !path_.empty(); }
  [[nodiscard]] std::filesystem::path scene() const { return path_ / "scene.glb"; }
  [[nodiscard]] std::filesystem::path picture() const { return path_ / "picture.png"; }

 private:
  std::filesystem::path path_;
};

/// Draws the scene of a folder into a PNG with f3d under Xvfb. Takes about a second. An earlier
/// file `png` stays as it is unless the picture is complete.
[[nodiscard]] Status render(const DrawingFolder& folder, const Camera& camera,
                            const PictureSize& size, const std::filesystem::path& png);

}  // namespace sunder::tools
