#pragma once

#include "tear/geometry/blade_plane.h"
#include "tear/operation/outcome.h"
#include "tear/operation/stroke_tip.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// Tears the layer that the sweep of one segment meets first, without width. The path continues
/// from the tip, or enters where the blade meets the surface, and is opened piece by piece.
/// @param tip  the tip of the tear; moved to its new place.
void tear_nearest_layer(const BladePlane& plane, const Workpiece& work, StrokeTip& tip,
                        Outcome& outcome);

}  // namespace sunder::tear
