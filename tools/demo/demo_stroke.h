#pragma once

#include <sunder/operation/operation.h>

#include "tools/picture/view.h"

namespace sunder::tools {

/// A stroke, and the view from which it is seen.
struct SeenStroke {
  Stroke stroke;  ///< Empty: nothing is visible.
  ViewFrame frame;
  double score = 0;  ///< Grows with the length on the surface, and with how it faces the eye.
};

/// A slightly curved stroke along the longest stretch of unbroken surface that is visible from
/// `frame`. Deterministic.
[[nodiscard]] SeenStroke choose_stroke(const Character& character,
                                       const std::vector<DeformedMesh>& posed,
                                       const ViewFrame& frame);

/// The same for the broader side of the model, or for another side, also from above, if a stroke
/// is seen much better there.
[[nodiscard]] SeenStroke choose_stroke(const Character& character,
                                       const std::vector<DeformedMesh>& posed);

}  // namespace sunder::tools
