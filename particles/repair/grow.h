#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

// A particle that a tear may have divided is grown anew from its seed, so that it is in one piece.

/// Begins to grow a particle: RepairScratch::band_front then has to be run until it is done, in any
/// number of calls.
void begin_growing(StructureEdit& edit, Index particle);
/// Takes from the particle the points that the front did not reach. @return their number.
Index finish_growing(StructureEdit& edit, Index particle);

}  // namespace sunder::particles
