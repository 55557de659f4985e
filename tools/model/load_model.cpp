#include "tools/model/load_model.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

namespace sunder::tools {

LoadOptions with_roots(LoadOptions options,
                       const std::vector<std::filesystem::path>& package_roots) {
  options.roots.insert(options.roots.end(), package_roots.begin(), package_roots.end());
  return options;
}

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
