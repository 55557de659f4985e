#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Removes points without a face after a call from all particles. @return those points.
std::vector<Index> leave_lost_points(StructureEdit& edit, std::span<const ChangeRecord> changes);

/// Updates the points of vertices. @param lost  appended: as leave_lost_points().
void renew_vertex_points(StructureEdit& edit, std::span<const ChangeRecord> changes,
                         std::vector<Index>& lost);

}  // namespace sunder::particles
