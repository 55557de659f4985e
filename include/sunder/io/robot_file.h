#pragma once

#include <sunder/core/math.h>
#include <sunder/io/character_file.h>
#include <sunder/robot/robot.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sunder {

/// The consequence of a finding about a robot's file.
enum class RobotSeverity : std::uint8_t {
  information,  ///< Something is ignored or worth knowing; the robot is as the file says.
  warning,      ///< The robot differs from what the file says. Refused if options are strict.
  error,        ///< The file is refused.
};

/// The enumerator's name as text, for logs and JSON ("warning").
[[nodiscard]] SUNDER_API std::string_view robot_severity_name(RobotSeverity severity);

/// Something that loading found in a robot's file. docs/robot.md lists all codes.
struct RobotFinding {
  std::string_view code;  ///< Stable: "mesh_not_found", "mimic_self".
  RobotSeverity severity = RobotSeverity::information;
  std::string place;       ///< "joint 'elbow'", "link 'base'"; empty: the file.
  std::uint32_t line = 0;  ///< Of the file, from 1; 0: unknown.
  std::string text;        ///< One sentence: what is wrong, and what loading made of it.
};

/// The shapes of a link that become its mesh.
enum class RobotShapes : std::uint8_t {
  visual,               ///< `<visual>`.
  collision,            ///< `<collision>`.
  visual_or_collision,  ///< Those of `<collision>` if no link of the robot has a visual one.
  none,                 ///< The character has bones only; no mesh file is read.
};

struct RobotLoadOptions {
  /// Refuses what would otherwise be repaired or left out: every warning becomes an error.
  bool strict = false;
  /// Folders that hold packages: `package://NAME/...` is NAME/... in the first of them that has a
  /// folder NAME. Mesh files are read from these folders and the URDF's own folder only.
  std::vector<std::filesystem::path> package_roots = {};
  RobotShapes shapes = RobotShapes::visual_or_collision;
  /// Turns COLLADA meshes whose up axis is not z so that it becomes z. Usual programs for URDF
  /// (RViz, Gazebo) ignore the up axis, and meshes are made for them.
  bool applies_collada_up_axis = false;
  /// Limit for the URDF file itself.
  std::uint64_t maximum_urdf_bytes = std::uint64_t{16} << 20;
  /// For the mesh files: limits, and where they are imported. `roots` are further package roots.
  LoadOptions meshes = {};
};

/// A robot, and the character that shows it.
struct LoadedRobot {
  Robot robot;  ///< Satisfies validate_robot().
  /// Bone i is link i, with the link's name. In the rest pose the joints have rest_values(). A
  /// link's shapes are one mesh, which only its bone moves. Satisfies validate_character() if it
  /// has a mesh, and save_glb() takes it then.
  LoadedCharacter model;
  /// The root link in model space, whose y axis is up as in glTF. Robots have z up.
  Affine3d model_from_root = Affine3d::Identity();
  std::vector<RobotFinding> findings;  ///< In the order of the file, no error among them.
};

/// Reads a URDF file and the meshes of its links (STL, COLLADA, OBJ and what else load_character()
/// reads). Conventions, limits and findings: docs/robot.md. Thread-safe.
///
/// @param findings  if not null, replaced by all findings, also if the file is refused.
/// @return file_not_found, file_unreadable; limit_exceeded (size, depth); malformed_file,
/// not_a_tree, invalid_argument, …: the first error among the findings, with its line as index.
[[nodiscard]] SUNDER_API Result<LoadedRobot> load_robot(
    const std::filesystem::path& file, const RobotLoadOptions& options = {},
    std::vector<RobotFinding>* findings = nullptr);

}  // namespace sunder
