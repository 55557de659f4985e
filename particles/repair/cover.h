#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Makes a particle at a point that has none near enough: at once, so that the result does not
/// depend on where a call of settle() ends.
void cover(StructureEdit& edit, Index point);

/// The same for all points that were taken up.
void cover_taken_up(StructureEdit& edit);

}  // namespace sunder::particles
