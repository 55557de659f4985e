#pragma once

#include <sunder/core/operation.h>

#include "io/operation_log/place.h"

namespace sunder::operation_log {

/// Throws a Fault.
PoseSpec read_pose(const Place& place);

}  // namespace sunder::operation_log
