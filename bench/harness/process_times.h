#pragma once

#include <string>
#include <vector>

namespace sunder::bench {

/// A program and its arguments.
using Command = std::vector<std::string>;

/// Median seconds of a whole process, from its start to its end.
struct ProcessTimes {
  double wall = 0;
  double cpu = 0;  ///< In the program and in the kernel.
};

/// The times of each command, run in turns. What they print is thrown away. Ends the program if a
/// command cannot be started or is killed.
[[nodiscard]] std::vector<ProcessTimes> time_processes(const std::vector<Command>& commands,
                                                       int rounds);

}  // namespace sunder::bench
