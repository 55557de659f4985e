#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sunder::test {

struct CommandResult {
  int exit_code = -1;  ///< -1: it crashed or did not start.
  std::string out, err;
};

/// Runs the built `sunder` with these arguments; these variables replace those of the environment.
CommandResult run_sunder(const std::vector<std::string>& arguments,
                         const std::vector<std::pair<std::string, std::string>>& environment = {});

}  // namespace sunder::test
