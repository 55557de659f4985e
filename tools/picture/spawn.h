#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace sunder::tools {

/// Whether `name` is an executable in one of the folders of PATH.
[[nodiscard]] bool is_program_there(const std::string& name);

/// Runs a program of PATH with these arguments, the name first, without a shell. Its output is
/// discarded. It is killed, with all processes that it started, if it takes longer than `limit`.
/// @return its exit code; nothing if it could not start, was killed or crashed.
[[nodiscard]] std::optional<int> run_program(const std::vector<std::string>& arguments,
                                             std::chrono::seconds limit);

}  // namespace sunder::tools
