#pragma once

#include <sunder/core/status.h>
#include <sunder/tear/torn_model.h>

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Checks that before each operation every vertex of the faces that it changed or made was at a
/// point at which a face used it, or at none if no face did; and before the first one at its point
/// of the decomposition. All indices must have been checked. O(faces + logged changes).
/// @throws std::bad_alloc
/// @return the operation of the first fault.
[[nodiscard]] Status check_vertex_history(const Structure& structure,
                                          const Structure& decomposition, const TornModel& model);

}  // namespace sunder::particles
