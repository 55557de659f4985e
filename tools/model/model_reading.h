#pragma once

#include <sunder/io/character_file.h>
#include <sunder/io/robot_file.h>

#include <filesystem>
#include <vector>

namespace sunder::tools {

/// How a verb reads its models, as its command line says.
struct ModelReading {
  bool strict = false;                               ///< Refuses what loading would repair.
  std::vector<std::filesystem::path> package_roots;  ///< Folders of the packages of robots.
  double import_seconds = LoadOptions{}.import_seconds;
  double memory = 0;  ///< Megabytes, 2^20 bytes; 0: LoadOptions::maximum_memory's own rule.
};

[[nodiscard]] LoadOptions load_options(const ModelReading& reading);

/// The same for a robot and its meshes.
[[nodiscard]] RobotLoadOptions robot_load_options(const ModelReading& reading);

}  // namespace sunder::tools
