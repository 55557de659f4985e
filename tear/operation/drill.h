#pragma once

#include <sunder/core/status.h>
#include <sunder/operation/operation.h>

#include "tear/operation/outcome.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// @return non_finite_value; invalid_argument if the direction is zero or the radius, depth or
///         tolerance is out of range.
[[nodiscard]] Status validate_bore(const Bore& bore);

/// Removes the posed surface inside a bore and, if requested, lines it with a wall. Fills in the
/// report, except the figures that come from the change record.
///
/// The bore is cut as a prism whose corners lie on the circle and whose sides stay within the chord
/// tolerance of it.
void drill_surface(const Bore& bore, const Workpiece& work, Outcome& outcome);

}  // namespace sunder::tear
