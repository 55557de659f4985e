#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Regrows a particle from its seed: points that it no longer reaches leave it. @return its former
/// number of points.
Index grow_anew(StructureEdit& edit, Index particle);

}  // namespace sunder::particles
