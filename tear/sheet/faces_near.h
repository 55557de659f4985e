#pragma once

#include "tear/geometry/plane_side.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// The live faces that may meet the plane of a sheet, without those that lie beyond one of its
/// bounds: all that have points on both sides of the plane or on it, and others near it. In no
/// particular order. The cost depends on the faces near the plane and hardly on the size of the
/// surface.
[[nodiscard]] ScratchVector<Index> faces_near(const Sheet& sheet, const SurfaceEditor& editor,
                                              PosedPoints& posed);

}  // namespace sunder::tear
