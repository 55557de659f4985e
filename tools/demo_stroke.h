#pragma once

#include <sunder/operation/operation.h>

#include "tools/view.h"

namespace sunder::tools {

/// A slightly curved stroke where the model shows the longest stretch of one unbroken surface, seen
/// from `frame`. Deterministic.
/// @return no stroke where nothing is seen.
[[nodiscard]] Stroke choose_stroke(const Character& character,
                                   const std::vector<DeformedMesh>& posed, const ViewFrame& frame);

}  // namespace sunder::tools
