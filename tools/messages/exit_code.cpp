#include "tools/messages/exit_code.h"

#include "tools/messages/messages.h"

namespace sunder::tools {

ExitCode exit_code_of(StatusCode code, ExitCode otherwise) {
  switch (code) {
    case StatusCode::ok: return ExitCode::ok;
    case StatusCode::file_not_found:
    case StatusCode::file_unreadable: return ExitCode::unreadable_input;
    case StatusCode::limit_exceeded:
    case StatusCode::capacity_exceeded: return ExitCode::limit_exceeded;
    case StatusCode::internal_error: return ExitCode::internal_error;
    default: return otherwise;
  }
}

ExitCode complain(const std::string& place, const Status& status, ExitCode otherwise,
                  const std::string& advice) {
  print_error("sunder: " + place + ": " + std::string(status.text()) + advice + " (" +
              std::string(status_name(status.code())) + ")");
  return exit_code_of(status.code(), otherwise);
}

}  // namespace sunder::tools
