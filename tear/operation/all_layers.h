#pragma once

#include "tear/geometry/blade_plane.h"
#include "tear/operation/outcome.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// Tears every layer that the sweep of one segment meets. The sweep is a sheet, like that of a cut.
void tear_all_layers(const BladePlane& plane, const Workpiece& work, Outcome& outcome);

}  // namespace sunder::tear
