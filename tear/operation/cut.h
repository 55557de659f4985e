#pragma once

#include <sunder/core/status.h>
#include <sunder/operation/operation.h>

#include "tear/operation/outcome.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// @return non_finite_value, or invalid_argument: no normal, bounds that are not a convex polygon.
[[nodiscard]] Status validate_cut(const PlaneCut& cut);

/// Opens the posed surface along a plane and closes what was opened with caps, if wanted. Fills in
/// the report but for what comes from the change record.
void cut_surface(const PlaneCut& cut, const Workpiece& work, Outcome& outcome);

}  // namespace sunder::tear
