#pragma once

#include "particles/clusters/band.h"
#include "particles/repair/structure_edit.h"

namespace sunder::particles {

/// Begins the band next to the lips of a tear, and handles the lips themselves. Work that is left
/// is continued after it.
/// @param lips      points on the lips, at least one: the new ones, or all of a complete tear.
/// @param is_final  whether the tear is complete.
void begin_band(StructureEdit& edit, std::span<const Index> lips, bool is_final);

/// Begins the band of a bore, which has no lips: particles that lost members to it are regrown.
void begin_hole(StructureEdit& edit);

/// Continues the band for at most the given number of points, until it is complete or the work goes
/// on at another tear than that of the edit.
/// @return the number of points left.
Index widen_band(StructureEdit& edit, Index points);

/// The work that is left; null: none. A band in progress counts as one that was not begun.
[[nodiscard]] std::shared_ptr<const PendingWork> pending_work(const Structure& structure);
/// Sets the work that is left.
/// @param waits  whether settle() leaves it alone.
void resume_work(Structure& structure, const std::shared_ptr<const PendingWork>& work, bool waits);

}  // namespace sunder::particles
