#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Appends the points and vertices of the model that the structure does not have, without
/// memberships.
void append_points(StructureEdit& edit);

/// Gives new points the memberships of the points around them, along the torn surface, so that each
/// lip gets them from its own side.
/// @param undecided_tear  as of StructureEdit::may_join().
void spread_to_new_points(StructureEdit& edit, Index undecided_tear);

}  // namespace sunder::particles
