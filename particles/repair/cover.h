#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Whether a particle is near enough to a point.
[[nodiscard]] bool is_covered(const StructureEdit& edit, Index point);

/// Creates a particle at a point that is not covered.
/// @return the number of points visited.
Index cover(StructureEdit& edit, Index point);

/// The same for all points of the edit.
void cover_taken_up(StructureEdit& edit);

/// Goes on to create a particle at Band::uncovered: thousands of points belong to it where faces
/// are small. The band waits for it, so that the result does not depend on where a call of settle()
/// ends. @param points  as in widen_band(); reduced by the work done.
void go_on_covering(StructureEdit& edit, Index& points);

}  // namespace sunder::particles
