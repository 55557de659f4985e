#pragma once

#include <sunder/robot/trajectory.h>

#include <cstddef>
#include <string_view>

namespace sunder::trajectory {

constexpr std::size_t kMaximumBytes = std::size_t{64} << 20;
constexpr std::size_t kMaximumNames = 1000;

/// Implements parse_trajectory_csv(). Out of memory: throws std::bad_alloc.
[[nodiscard]] Result<RobotTrajectory> read_csv(std::string_view text);

/// Implements parse_trajectory_json(); throws operation_log::Fault.
[[nodiscard]] RobotTrajectory read_json(std::string_view text);

}  // namespace sunder::trajectory
