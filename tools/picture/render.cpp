#include "tools/picture/render.h"

#include <chrono>
#include <string>
#include <system_error>
#include <vector>

#include "tools/messages/printed.h"
#include "tools/picture/spawn.h"

namespace sunder::tools {
namespace {

std::string numbers(const Vec3d& v) { return printed("%.9g,%.9g,%.9g", v.x(), v.y(), v.z()); }

}  // namespace

bool can_draw() { return is_program_there("f3d") && is_program_there("xvfb-run"); }

std::filesystem::path scene_file(const std::filesystem::path& png) {
  std::filesystem::path scene = png;
  return scene.replace_extension(".scene.glb");
}

Status render(const std::filesystem::path& scene, const Camera& camera, const PictureSize& size,
              const std::filesystem::path& png) {
  const std::vector<std::string> arguments = {
      "xvfb-run",
      "-a",
      "f3d",
      scene.string(),
      "--output=" + png.string(),
      "--dry-run",
      "--quiet",
      "--resolution=" + std::to_string(size.width) + "," + std::to_string(size.height),
      "--bg-color=0.93,0.94,0.95",
      "--fxaa",
      "--depth-peeling",
      "--camera-position=" + numbers(camera.eye),
      "--camera-focal-point=" + numbers(camera.focal_point),
      "--camera-view-up=" + numbers(camera.up),
      "--camera-view-angle=" + std::to_string(camera.view_angle_degrees)};
  std::error_code ignored;
  std::filesystem::remove(png, ignored);
  // Two xvfb-run that start at the same time may choose the same display; the one that fails is
  // started again.
  for (int attempt = 0; attempt < 3 && !std::filesystem::exists(png, ignored); ++attempt)
    (void)run_program(arguments, std::chrono::seconds(120));
  const bool is_drawn = std::filesystem::exists(png, ignored);
  std::filesystem::remove(scene, ignored);
  return is_drawn ? Status()
                  : Status::failure(StatusCode::internal_error, kNone, "f3d wrote no picture");
}

}  // namespace sunder::tools
