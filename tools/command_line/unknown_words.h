#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace sunder::tools {

/// The error for a command line with an unknown verb or option, or with an argument too many. It
/// proposes similar names. Empty if each word was understood.
/// @param app  after parse() has thrown.
[[nodiscard]] std::string unknown_word(const CLI::App& app);

}  // namespace sunder::tools
