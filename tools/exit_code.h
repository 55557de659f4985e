#pragma once

#include <sunder/core/status.h>

#include <string>

namespace sunder::tools {

/// What the command's exit tells a script; see docs/command.md.
enum class ExitCode : int {
  ok = 0,
  findings = 1,          ///< Done, but something is worth a look.
  usage = 2,             ///< The command line or the operations ask for what cannot be.
  unreadable_input = 3,  ///< A file that cannot be read, or written.
  limit_exceeded = 4,
  internal_error = 5,
};

/// The code for a failure; `otherwise` where its cause alone does not say whose fault it is.
[[nodiscard]] ExitCode exit_code_of(StatusCode code, ExitCode otherwise);

/// Says on stderr what failed and where. @return exit_code_of() it.
[[nodiscard]] ExitCode complain(const std::string& place, const Status& status, ExitCode otherwise);

}  // namespace sunder::tools
