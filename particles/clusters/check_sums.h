#pragma once

#include <sunder/core/status.h>
#include <sunder/tear/torn_model.h>

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Computes anew what operations keep up to date in a structure, and compares: the point of each
/// vertex, which points belong to particles, the cells of particles, and the sums of their members.
/// They differ by rounding only. The structure is complete; it is changed for the time of the call.
/// O(faces + members of particles with other members than before x influences).
/// @throws std::bad_alloc
/// @return the first fault.
[[nodiscard]] Status check_sums(Structure& structure, const Structure& decomposition,
                                const TornModel& model);

}  // namespace sunder::particles
