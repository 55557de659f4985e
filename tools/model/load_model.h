#pragma once

#include <sunder/io/character_file.h>
#include <sunder/io/robot_file.h>

#include <filesystem>
#include <vector>

namespace sunder::tools {

/// The same options with further folders: those that hold the packages of a robot.
[[nodiscard]] LoadOptions with_roots(LoadOptions options,
                                     const std::vector<std::filesystem::path>& package_roots);

/// Whether a file is a robot, by its ending.
[[nodiscard]] bool is_urdf(const std::filesystem::path& file);

/// A robot without its shapes: its joints and limits.
[[nodiscard]] Result<Robot> load_joints(const std::filesystem::path& urdf);

}  // namespace sunder::tools
