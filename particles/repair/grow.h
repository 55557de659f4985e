#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

// A particle that a tear may have divided is grown anew from its seed, so that it is in one piece.

/// Begins to grow a particle: RepairScratch::band_front then has to be run until it is done, in any
/// number of calls.
void begin_growing(StructureEdit& edit, Index particle);
/// Members of a particle that the front did not reach, descending.
[[nodiscard]] std::vector<Index> unreached_members(const StructureEdit& edit, Index particle);
/// Takes a point from the particle. It gets another one if it needs one.
/// @return the number of points visited.
Index leave_unreached(StructureEdit& edit, Index particle, Index point);

}  // namespace sunder::particles
