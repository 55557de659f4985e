#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Brings Structure::lips up to date.
/// @param lips  points that are new on lips. @param lost  points that have no face any more.
void renew_lip_edges(StructureEdit& edit, std::span<const Index> lips, std::span<const Index> lost);

}  // namespace sunder::particles
