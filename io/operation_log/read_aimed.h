#pragma once

#include <sunder/operation/aimed_operation.h>

#include <string>

#include "io/operation_log/place.h"

namespace sunder::operation_log {

/// Whether an operation of that name is aimed: slash, sever, puncture, incision.
bool is_aimed(const std::string& name);

/// @param name  of an aimed operation. Throws a Fault.
AimedOperation read_aimed(const Place& place, const std::string& name);

}  // namespace sunder::operation_log
