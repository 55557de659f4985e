#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace sunder::test {

/// The content of a file; empty if it cannot be read.
std::string read_text(const std::filesystem::path& file);

struct CommandResult {
  int exit_code = -1;  ///< -1: it crashed or did not start.
  std::string out, err;
};

/// Runs a program with these arguments; these variables replace those of the environment.
CommandResult run_program(const char* program, const std::vector<std::string>& arguments,
                          const std::vector<std::pair<std::string, std::string>>& environment = {});

/// The same with the built `sunder`, and with one that was built without the page of `sunder
/// validate`.
CommandResult run_sunder_without_page(const std::vector<std::string>& arguments);
CommandResult run_sunder(const std::vector<std::string>& arguments,
                         const std::vector<std::pair<std::string, std::string>>& environment = {});

/// The same with a terminal as stderr.
CommandResult run_sunder_on_terminal(
    const std::vector<std::string>& arguments,
    const std::vector<std::pair<std::string, std::string>>& environment = {});

}  // namespace sunder::test
