#pragma once

#include <sunder/operation/operation.h>

#include <string>

namespace sunder::operation_log {

/// One operation as JSON on one line, except that each blade of a stroke has its own line.
void append_operation(std::string& text, const Operation& operation);

}  // namespace sunder::operation_log
