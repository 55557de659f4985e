#pragma once

#include <sunder/core/status.h>

#include <string>

namespace sunder::tools {

/// The exit codes of the command; see docs/command.md.
enum class ExitCode : int {
  ok = 0,
  findings = 1,          ///< Done, with findings that need attention.
  usage = 2,             ///< The command line or the operations are invalid.
  unreadable_input = 3,  ///< A file cannot be read or written.
  limit_exceeded = 4,
  internal_error = 5,
};

/// The exit code for a failure; `otherwise` if the status code alone does not determine it.
[[nodiscard]] ExitCode exit_code_of(StatusCode code, ExitCode otherwise);

/// A text of io, in which options of the command stand for the members of LoadOptions that they
/// set.
[[nodiscard]] std::string with_option_names(std::string text);

/// The text of a failure for a line that begins with its place: without the name of the file that
/// the place ends with, and with_option_names().
[[nodiscard]] std::string failure_text(const std::string& place, const Status& status);

/// Reports on stderr what failed and where.
/// @param advice  follows the text of the failure: "; did you mean 'Walk'?".
/// @return exit_code_of() the failure.
[[nodiscard]] ExitCode complain(const std::string& place, const Status& status, ExitCode otherwise,
                                const std::string& advice = {});

}  // namespace sunder::tools
