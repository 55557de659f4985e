#pragma once

#include <sunder/core/status.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace sunder::bench {

/// The time of forward kinematics of a robot, warm.
struct KinematicsTime {
  std::string robot;
  std::uint32_t joints = 0;
  std::uint32_t moving_joints = 0;  ///< Those that are not fixed.
  double ns_per_joint = 0;          ///< Best of several runs, all joints counted.
  double ns_per_moving_joint = 0;
};

/// A chain of 40 revolute joints with turned origins and axes.
[[nodiscard]] Result<KinematicsTime> time_chain();

/// A robot's URDF file, such as simple_humanoid of the shared models. Its meshes are not read.
[[nodiscard]] Result<KinematicsTime> time_robot(const std::filesystem::path& urdf);

}  // namespace sunder::bench
