#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Decides for each particle that a tear touches with which lip it stays: the one that is nearer to
/// its seed.
/// @param lips  new points on the lips.
void choose_sides(StructureEdit& edit, std::span<const Index> lips);

}  // namespace sunder::particles
