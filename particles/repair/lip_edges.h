#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Updates Structure::lips.
/// @param lips  new points on lips.
/// @param lost  points that no longer have a face.
void renew_lip_edges(StructureEdit& edit, std::span<const Index> lips, std::span<const Index> lost);

/// Updates the edges of lips at a point between which the surface was closed.
void revise_lip_edges(StructureEdit& edit, Index point);

}  // namespace sunder::particles
