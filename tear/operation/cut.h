#pragma once

#include <sunder/core/skeleton.h>
#include <sunder/core/status.h>
#include <sunder/operation/operation.h>

#include "tear/operation/outcome.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// @return non_finite_value; invalid_argument if the normal is zero or the bounds are not a convex
///         polygon, or the ray has no length along the plane; not_found for an unknown bone.
[[nodiscard]] Status validate_cut(const PlaneCut& cut, const Skeleton& skeleton);

/// Opens the posed surface along a plane and, if requested, closes the sections with caps. Fills in
/// the report, except the figures that come from the change record.
void cut_surface(const PlaneCut& cut, const Workpiece& work, Outcome& outcome);

}  // namespace sunder::tear
