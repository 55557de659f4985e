#pragma once

#include <sunder/operation/operation.h>

#include "io/operation_log/place.h"

namespace sunder::operation_log {

// Both throw a Fault.

/// The field "weights" of an operation.
WeightOptions read_weight_options(const Place& place);

/// The operation "weights".
WeightsOperation read_weights(const Place& place);

/// Number of operations, at least 1.
std::uint32_t read_operation_count(const Place& place);

}  // namespace sunder::operation_log
