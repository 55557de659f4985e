#pragma once

#include "tools/model/posed_model.h"
#include "tools/picture/labels.h"
#include "tools/picture/marks.h"

namespace sunder::tools {

/// Draws the directions of the axes with their letters in the lower left corner.
void draw_axes(Marks& marks, Labels& labels);

struct Grid {
  double spacing = 1, height = 0;  ///< Metres; y.
};

/// The grid under a model: a power of ten as spacing, at y = 0, or at the model's lowest point if
/// that is lower.
[[nodiscard]] Grid choose_grid(const Bounds& model);
/// Draws lines at multiples of the spacing, every tenth heavier.
void draw_grid(const Grid& grid, const Bounds& model, Marks& marks);

}  // namespace sunder::tools
