#pragma once

#include <sunder/io/robot_file.h>

#include <filesystem>
#include <string>

#include "io/urdf/findings.h"

namespace sunder::urdf {

/// Reads the text of a URDF file. What is wrong becomes a finding; the result is an error if one of
/// them is.
/// @param file  in whose folder the meshes are.
[[nodiscard]] Result<LoadedRobot> read_robot(std::string text, const std::filesystem::path& file,
                                             const RobotLoadOptions& options, Findings& findings);

}  // namespace sunder::urdf
