#pragma once

#include "bench/weights_figures.h"

namespace sunder::bench {

/// Draws error against time as SVG: a small mark a model, policy and K, a large one for the median
/// over models.
/// @return false where it cannot be written.
[[nodiscard]] bool write_weights_picture(const std::vector<ModelFigures>& models, const char* file);

}  // namespace sunder::bench
