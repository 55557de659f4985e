#pragma once

#include <sunder/plan/plan.h>

#include "pipeline/plan/blade_chain.h"

namespace sunder::plan {

/// @return invalid_argument, which names the field.
[[nodiscard]] Status check_timing(const PlanTiming& timing, const PlanOptions& options);
/// @return invalid_argument for a blade that is shorter than the wound is deep.
[[nodiscard]] Status check_blade(const WoundTarget& target, const BladeChain& chain);
/// @return index_out_of_range for a link; the fault of a shape.
[[nodiscard]] Status check_shapes(const PlanTool& tool);

}  // namespace sunder::plan
