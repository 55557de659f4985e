#pragma once

#include <sunder/operation/operation.h>

#include "io/operation_log/place.h"

namespace sunder::operation_log {

/// Throws a Fault.
PoseSpec read_pose(const Place& place);

}  // namespace sunder::operation_log
