#pragma once

#include "bench/harness/json_object.h"

namespace sunder::bench {

/// Adds the ratios of single operations: of widths and bores to plain tears, of plane cuts to those
/// of VTK. About a minute. Null where bench_cuts is not built, or without VTK.
void add_operation_ratios(JsonObject& object);

}  // namespace sunder::bench
