#pragma once

#include <sunder/operation/operation.h>

#include <string>

namespace sunder::operation_log {

/// One operation as JSON: on one line, but for a stroke, whose blades take a line each.
void append_operation(std::string& text, const Operation& operation);

}  // namespace sunder::operation_log
