#pragma once

#include <sunder/operation/operation.h>

#include "tear/operation/outcome.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

[[nodiscard]] Status validate_weld(const Weld& weld);

/// Closes lips that lie on one another: the walls and caps between them go, each side gets the
/// points that only the other one has, and their edges and points become one again. What cannot be
/// joined stays open and is counted as blocked.
void weld_surface(const Weld& weld, const Workpiece& work, Outcome& outcome);

}  // namespace sunder::tear
