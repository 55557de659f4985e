#pragma once

#include <sunder/operation/operation.h>

#include <vector>

#include "io/operation_log/place.h"

namespace sunder::operation_log {

/// All operations of a log. Throws a Fault.
std::vector<Operation> read_log(const Json& log);

}  // namespace sunder::operation_log
