#pragma once

#include <sunder/certificate/certificate.h>

#include <filesystem>
#include <string>

namespace sunder::tools {

/// Reads joint limits: {"limits": {"bone": {"angle": 60}}}. Bones that the file does not name keep
/// their free limits. Of a URDF file, the limits of its joints, for the bones that have the names
/// of its links, and whose bind pose is the robot's rest pose.
/// @return the failures of read_json_object(), bind_pose() and free_joint_limits(); malformed_file,
/// or not_found for a bone that the character does not have.
[[nodiscard]] Result<JointLimits> read_joint_limits(const std::filesystem::path& file,
                                                    const Character& character);

/// The limits that `--limits` names: "none", "clips" or a file.
/// @return also empty_input for "clips" of a character without clips: nothing would move.
[[nodiscard]] Result<JointLimits> joint_limits_named(const std::string& name,
                                                     const Character& character,
                                                     const ModelPose& bind);

}  // namespace sunder::tools
