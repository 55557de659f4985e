#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Begins the band next to the lips of a tear, and handles the lips themselves.
/// @param lips  new points on the lips; at least one.
void begin_band(StructureEdit& edit, std::span<const Index> lips);

/// Begins the band of a bore, which has no lips: particles that lost members to it are regrown.
void begin_hole(StructureEdit& edit);

/// Continues the band for at most the given number of points.
void widen_band(StructureEdit& edit, Index points);

}  // namespace sunder::particles
