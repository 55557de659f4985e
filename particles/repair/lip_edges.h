#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Updates Structure::lips.
/// @param lips  new points on lips.
/// @param lost  points that no longer have a face.
void renew_lip_edges(StructureEdit& edit, std::span<const Index> lips, std::span<const Index> lost);

}  // namespace sunder::particles
