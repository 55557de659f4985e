#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Creates a particle at a point that has none near enough. This is not deferred, so that the
/// result does not depend on where a call of settle() ends.
/// @return the number of points visited.
Index cover(StructureEdit& edit, Index point);

/// The same for all points of the edit.
void cover_taken_up(StructureEdit& edit);

}  // namespace sunder::particles
