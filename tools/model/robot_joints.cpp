#include "tools/model/robot_joints.h"

#include <sunder/io/robot_file.h>

#include <utility>

#include "io/internal/lower_extension.h"

namespace sunder::tools {

bool is_urdf(const std::filesystem::path& file) { return lower_extension(file) == ".urdf"; }

Result<Robot> load_joints(const std::filesystem::path& urdf) {
  RobotLoadOptions options;
  options.shapes = RobotShapes::none;
  Result<LoadedRobot> loaded = load_robot(urdf, options);
  if (!loaded) return loaded.error();
  return std::move(loaded->robot);
}

}  // namespace sunder::tools
