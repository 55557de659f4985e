#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace sunder::tools {

/// Whether `name` is an executable in one of the folders of PATH.
[[nodiscard]] bool is_program_there(const std::string& name);

/// Runs a program of PATH with these arguments, the name first, no shell between; its output goes
/// nowhere. It and whatever it started is killed when it takes longer than `limit`.
/// @return its exit code; nothing where it could not start, was killed, or crashed.
[[nodiscard]] std::optional<int> run_program(const std::vector<std::string>& arguments,
                                             std::chrono::seconds limit);

}  // namespace sunder::tools
