#pragma once

#include <sunder/operation/operation.h>

#include "tools/model/surface_kinds.h"
#include "tools/picture/view.h"

namespace sunder::tools {

/// A stroke, and the view from which it is seen.
struct SeenStroke {
  Stroke stroke;  ///< Empty: nothing is visible.
  ViewFrame frame;
  double score = 0;  ///< Grows with the length on the surface, and with how it faces the eye.
};

/// A slightly curved stroke along the longest stretch of unbroken surface that is visible from the
/// broader side of the model, or from another side, also from above, if it is seen much better
/// there. It is on skin, if the model has a stretch of it that is large enough, otherwise on what
/// may have flesh, otherwise anywhere. Deterministic.
[[nodiscard]] SeenStroke choose_stroke(const Character& character, const SurfaceKinds& kinds,
                                       const std::vector<DeformedMesh>& posed);

}  // namespace sunder::tools
