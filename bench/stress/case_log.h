#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/stress/worker.h"

namespace sunder::stress {

/// One line of JSON.
[[nodiscard]] std::string to_line(const Outcome& outcome, const Steps& steps = {});
/// @return whether the line is one that to_line() wrote.
[[nodiscard]] bool from_line(const std::string& line, Outcome& outcome, Steps& steps);

/// The cases of a file of lines; none if the file does not exist. A last line that was cut off is
/// left out.
[[nodiscard]] std::vector<std::pair<Outcome, Steps>> read_log(const std::filesystem::path& file);

}  // namespace sunder::stress
