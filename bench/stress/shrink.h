#pragma once

#include "bench/stress/worker.h"

namespace sunder::stress {

/// Leaves out steps of a case for as long as the first law that it broke stays broken.
/// @return the fewest steps that were found.
[[nodiscard]] Steps shrink(const Outcome& failed, double seconds_of_case);

}  // namespace sunder::stress
