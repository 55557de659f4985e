#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Makes the straight line between two points of one origin an edge by flipping the edges that
/// cross it.
/// @param face  a part of that origin.
/// @return false if an edge in the way cannot be flipped; others may have been.
[[nodiscard]] bool turn_edges_into_line(Index from, Index to, Index face, SurfaceEditor& editor);

}  // namespace sunder::tear
