#pragma once

#include "bench/harness/json_object.h"

namespace sunder::bench {

/// Adds the figures of the engine's loop and of its dearest events. About a minute.
void add_engine_figures(JsonObject& object);

}  // namespace sunder::bench
