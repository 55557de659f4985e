#include "tools/picture/render.h"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "tools/messages/printed.h"
#include "tools/messages/text_file.h"
#include "tools/picture/spawn.h"

namespace sunder::tools {
namespace {

std::string numbers(const Vec3d& v) { return printed("%.9g,%.9g,%.9g", v.x(), v.y(), v.z()); }

}  // namespace

bool can_draw() { return is_program_there("f3d") && is_program_there("xvfb-run"); }

DrawingFolder::DrawingFolder() {
  std::error_code error;
  std::string name = (std::filesystem::temp_directory_path(error) / "sunder-XXXXXX").string();
  if (!error && mkdtemp(name.data()) != nullptr) path_ = name;
}

DrawingFolder::~DrawingFolder() {
  std::error_code ignored;
  if (exists()) std::filesystem::remove_all(path_, ignored);
}

Status render(const DrawingFolder& folder, const Camera& camera, const PictureSize& size,
              const std::filesystem::path& png) {
  const std::vector<std::string> arguments = {
      "xvfb-run",
      "-a",
      "f3d",
      folder.scene().string(),
      "--output=" + folder.picture().string(),
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
  // Two xvfb-run that start at the same time may choose the same display; the one that fails is
  // started again.
  std::error_code ignored;
  for (int attempt = 0; attempt < 3 && !std::filesystem::exists(folder.picture(), ignored);
       ++attempt)
    (void)run_program(arguments, std::chrono::seconds(120));
  std::ifstream stream(folder.picture(), std::ios::binary);
  std::ostringstream picture;
  picture << stream.rdbuf();
  return stream ? write_text(png, picture.str())
                : Status::failure(StatusCode::internal_error, kNone, "f3d wrote no picture");
}

}  // namespace sunder::tools
