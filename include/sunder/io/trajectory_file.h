#pragma once

#include <sunder/robot/trajectory.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace sunder {

/// Reads a trajectory of a robot as CSV: a line of names, the first of which is `time`, and a line
/// of numbers per time, separated by commas. Empty lines and lines that begin with '#' are skipped.
/// Names and units are those of RobotTrajectory.
/// @return malformed_file, non_finite_value or invalid_argument, with the line as index and line
/// and
///         column in the text; empty_input without a time; limit_exceeded.
[[nodiscard]] SUNDER_API Result<RobotTrajectory> parse_trajectory_csv(std::string_view text);

/// Reads a trajectory as JSON: {"names": ["shoulder", …], "samples": [{"time": 0, "values": [0.1,
/// …]}, …]}.
/// @return as above; the text names the place as a JSON pointer, or line and column of a syntax
///         error.
[[nodiscard]] SUNDER_API Result<RobotTrajectory> parse_trajectory_json(std::string_view text);

/// A trajectory as CSV, which parse_trajectory_csv() reads back bit for bit.
/// @return size_mismatch if there is not one number per time and name; invalid_argument for a name
///         that CSV cannot have; limit_exceeded, out of memory.
[[nodiscard]] SUNDER_API Result<std::string> trajectory_csv(const RobotTrajectory& trajectory);

/// Reads a file, by its extension: .csv or .json.
/// @return as above; file_not_found, file_unreadable, unsupported_format.
[[nodiscard]] SUNDER_API Result<RobotTrajectory> load_trajectory(const std::filesystem::path& file);

}  // namespace sunder
