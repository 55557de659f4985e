#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace sunder::tools {

/// What to say of the first word of a command line that is neither a verb nor an option, with the
/// names that it may stand for. Empty if all words were understood.
/// @param app  after parse() has thrown.
[[nodiscard]] std::string unknown_word(const CLI::App& app);

}  // namespace sunder::tools
