#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Replaces the edge between two faces of one origin by the other diagonal of their quadrilateral:
/// (a, b, c), (b, a, d) become (a, d, c), (b, c, d). The shape of the surface does not change.
/// @return false if the faces have different origins, or a face would lose its area or be inverted;
///         then nothing is changed.
bool flip_edge(Index half_edge, SurfaceEditor& editor);

}  // namespace sunder::tear
