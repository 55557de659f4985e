#pragma once

#include "tear/surface/line_splitter.h"

namespace sunder::tear {

// Splits faces; the shape of the surface does not change.

/// Puts a new point on an edge, `fraction` of the way along the half-edge, and splits the faces on
/// both sides of it.
/// @return the point; kNone if a face would lose its area or turn over; then nothing is changed.
[[nodiscard]] Index split_edge(Index half_edge, double fraction, SurfaceEditor& editor,
                               Rounding rounding = Rounding::nearest);

/// Puts a new point into a triangle and splits it in three. @param barycentric  of its corners, all
/// > 0.
/// @return as split_edge().
[[nodiscard]] Index split_triangle(Index triangle, const std::array<double, 3>& barycentric,
                                   SurfaceEditor& editor);

}  // namespace sunder::tear
