#pragma once

#include <string>
#include <vector>

namespace sunder::bench {

/// A program and its arguments.
using Command = std::vector<std::string>;

/// Median wall seconds of each command as a whole process, from start to exit, in turns. What they
/// print is thrown away. Ends the program if a command cannot be started or is killed.
[[nodiscard]] std::vector<double> time_processes(const std::vector<Command>& commands, int rounds);

}  // namespace sunder::bench
