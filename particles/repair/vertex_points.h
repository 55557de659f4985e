#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Takes points out of all particles that a call left without a face. @return those points.
std::vector<Index> leave_lost_points(StructureEdit& edit, std::span<const ChangeRecord> changes);

/// Brings the points of vertices up to date. @param lost  appended: as leave_lost_points().
void renew_vertex_points(StructureEdit& edit, std::span<const ChangeRecord> changes,
                         std::vector<Index>& lost);

}  // namespace sunder::particles
