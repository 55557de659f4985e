#pragma once

#include "tear/geometry/plane_side.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// Whether it is faster to compare all vertices of a surface with an unbounded plane, one after the
/// other, than to search the patches that the plane may meet.
[[nodiscard]] bool is_scanned(const SurfaceEditor& editor, const PosedPoints& posed);

/// The live faces that may have points on both sides of a plane or on it: all that do, and those
/// that rounding cannot tell. Points are where their weights put them, none may be pinned.
/// O(vertices + triangles).
[[nodiscard]] ScratchVector<Index> scan_faces(const PlaneSide& plane, const SurfaceEditor& editor,
                                              PosedPoints& posed);

}  // namespace sunder::tear
