#pragma once

#include <sunder/core/status.h>
#include <sunder/operation/operation.h>

#include "tear/operation/outcome.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// @return non_finite_value, or invalid_argument: no direction, a radius, depth or tolerance out of
/// range.
[[nodiscard]] Status validate_bore(const Bore& bore);

/// Removes the posed surface inside a bore and lines it with a wall, if wanted. Fills in the report
/// but for what comes from the change record.
///
/// The round bore is cut as a prism whose corners lie on the circle: its sides stay within the
/// chord tolerance of it.
void drill_surface(const Bore& bore, const Workpiece& work, Outcome& outcome);

}  // namespace sunder::tear
