#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Begins the band beside the lips of a tear, and goes through the lips themselves.
/// @param lips  points that are new on the lips; at least one.
void begin_band(StructureEdit& edit, std::span<const Index> lips);

/// Begins the band of a bore, which has no lips: particles that its rim takes a part of are grown
/// anew.
void begin_hole(StructureEdit& edit);

/// Goes on with the band for at most so many points.
void widen_band(StructureEdit& edit, Index points);

}  // namespace sunder::particles
