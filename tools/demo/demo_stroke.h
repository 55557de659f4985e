#pragma once

#include <sunder/operation/operation.h>

#include "tools/picture/view.h"

namespace sunder::tools {

/// A slightly curved stroke along the longest stretch of unbroken surface that is visible from
/// `frame`. Deterministic. @return an empty stroke if nothing is visible.
[[nodiscard]] Stroke choose_stroke(const Character& character,
                                   const std::vector<DeformedMesh>& posed, const ViewFrame& frame);

}  // namespace sunder::tools
