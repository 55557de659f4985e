#pragma once

#include <sunder/core/status.h>
#include <sunder/robot/robot.h>

#include <filesystem>

namespace sunder::tools {

/// Whether a file is a robot, by its ending.
[[nodiscard]] bool is_urdf(const std::filesystem::path& file);

/// A robot without its shapes: its joints and limits.
[[nodiscard]] Result<Robot> load_joints(const std::filesystem::path& urdf);

}  // namespace sunder::tools
