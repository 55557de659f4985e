#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Replaces the edge between two faces of one origin by the other diagonal of their quadrilateral:
/// (a, b, c), (b, a, d) become (a, d, c), (b, c, d). The surface stays what it is.
/// @return false if the faces have different origins, or a face would lose its area or turn over;
///         then nothing is changed.
bool flip_edge(Index half_edge, SurfaceEditor& editor);

}  // namespace sunder::tear
