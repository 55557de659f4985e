#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Makes the straight line between two points of one source triangle an edge, by turning the edges
/// that cross it.
/// @param face  a part of that source triangle.
/// @return false where an edge in the way cannot be turned; some may have been.
[[nodiscard]] bool turn_edges_into_line(Index from, Index to, Index face, SurfaceEditor& editor);

}  // namespace sunder::tear
