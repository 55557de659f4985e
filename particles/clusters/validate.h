#pragma once

#include <sunder/core/status.h>
#include <sunder/tear/torn_model.h>

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Checks every number of a structure that was read, which may come from a stranger: indices, and
/// counts before each operation against those of the model; ranges; sums against what they add up.
/// Then derives what the record does not contain. O(size of the structure and of the model).
/// @return the first fault. @throws std::bad_alloc
[[nodiscard]] Status validate(Structure& structure, const Structure& decomposition,
                              const TornModel& model);

}  // namespace sunder::particles
