#pragma once

#include "particles/repair/lip_particles.h"

namespace sunder::particles {

// Next to a tip the small particles of a lip are followed by a row of little larger ones. All other
// particles fade out between the row and the lip.

/// Reduces the reach of all particles but those of the lip at a point between the row and the lip.
void fade_next_to_lip(StructureEdit& edit, const LipChain& chain, const BandPoint& at);

/// Creates a particle of the row at a point, if it is in the row and has none near enough.
/// @return the number of points visited.
Index cover_row(StructureEdit& edit, const LipChain& chain, const BandPoint& at);

}  // namespace sunder::particles
