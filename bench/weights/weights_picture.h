#pragma once

#include "bench/weights/weights_figures.h"

namespace sunder::bench {

/// Draws error against time as SVG: a small mark per model, policy and K, and a large one for the
/// median over models.
/// @return false if it cannot be written.
[[nodiscard]] bool write_weights_picture(const std::vector<ModelFigures>& models, const char* file);

}  // namespace sunder::bench
