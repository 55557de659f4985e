#pragma once

#include <array>
#include <optional>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Replaces the edge between two triangles of a flat cap by the other diagonal of their
/// quadrilateral: (a, b, c), (b, a, d) become (a, d, c), (b, c, d). Only for triangles that nothing
/// has split. The two are retired, and the new ones are fillings of their own, because the parts of
/// a face have one origin; the surface stays where it is in bind space, and weights between the
/// corners change as the diagonal does.
/// @param least_shape_factor  the least shape of the new faces, by that of the old ones.
/// @return the new faces; nullopt if the edge is none of a flat cap, or if a face would be thinner
///         or inverted; then nothing is changed.
std::optional<std::array<Index, 2>> flip_cap_edge(Index half_edge, double least_shape_factor,
                                                  SurfaceEditor& editor);

}  // namespace sunder::tear
