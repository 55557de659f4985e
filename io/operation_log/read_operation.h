#pragma once

#include <sunder/operation/aimed_operation.h>

#include <vector>

#include "io/operation_log/place.h"

namespace sunder::operation_log {

/// All operations of a log, none of them aimed. Throws a Fault.
/// @param model  whose materials may be named; null: none.
std::vector<Operation> read_log(const Json& log, const Character* model);

/// All operations of a log. Throws a Fault.
std::vector<LoggedOperation> read_aimed_log(const Json& log, const Character* model);

}  // namespace sunder::operation_log
