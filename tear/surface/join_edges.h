#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

// Joining faces again: the surface closes.

/// Joins two border half-edges that run between the same places in opposite directions. The points
/// at each end become one, the older of them; vertices that then differ in nothing but their tear
/// side do too, and others take the tear side of the point that is left.
/// @return false if the ends are not one surface point, in bind position, morphs and weights, bit
///         for bit, or a face would have a point twice; then nothing is changed.
[[nodiscard]] bool join_edges(Index a, Index b, SurfaceEditor& editor);

/// Puts a point on the border at another place, where its faces are all parts of one origin and
/// keep their winding. It gets one new vertex.
/// @param corner       of the point.
/// @param barycentric  of the place in the origin of that corner's face.
/// @param like         a vertex at that place, whose bind position, morphs and weights it gets.
/// @return false if it cannot be moved; then nothing is changed.
[[nodiscard]] bool move_border_point(Index corner, const std::array<double, 3>& barycentric,
                                     const VertexRef& like, SurfaceEditor& editor);

/// Remembers that the edges with these half-edges were welded.
void keep_scars(std::span<const Index> half_edges, SurfaceEditor& editor);

}  // namespace sunder::tear
