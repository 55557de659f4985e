#pragma once

#include "particles/repair/structure_edit.h"

namespace sunder::particles {

// After a weld, the surface leads across what was two lips: points leave these lips, particles
// reach over, and edges of lips end.

/// Removes the points that welds made one with others. @param lost  appended: those points.
void leave_welded_points(StructureEdit& edit, std::span<const ChangeRecord> changes,
                         std::vector<Index>& lost);

/// Takes welded points off the lips of which both sides met in them, and lets particles beside them
/// have the points across that are in their reach. O(points in reach of these particles)
void reach_across_welds(StructureEdit& edit, std::span<const ChangeRecord> changes);

/// Updates Structure::lips at welded points.
void renew_welded_lip_edges(StructureEdit& edit, std::span<const ChangeRecord> changes);

}  // namespace sunder::particles
