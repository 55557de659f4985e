#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Grows a particle from its seed again: points that it does not reach any more leave it. @return
/// how many points it had.
Index grow_anew(StructureEdit& edit, Index particle);

}  // namespace sunder::particles
