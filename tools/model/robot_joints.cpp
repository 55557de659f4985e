#include "tools/model/robot_joints.h"

#include <sunder/io/robot_file.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

namespace sunder::tools {

bool is_urdf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".urdf";
}

Result<Robot> load_joints(const std::filesystem::path& urdf) {
  RobotLoadOptions options;
  options.shapes = RobotShapes::none;
  Result<LoadedRobot> loaded = load_robot(urdf, options);
  if (!loaded) return loaded.error();
  return std::move(loaded->robot);
}

}  // namespace sunder::tools
