#pragma once

#include <vector>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Flips edges between parts of one origin where that improves the shape of the worse of the two
/// faces, until no flip does. The surface stays what it is, and so do lips and borders.
/// @param since  faces that changed since are looked at first. O(faces + edges flipped).
void improve_faces(const EditLog::Mark& since, SurfaceEditor& editor);

}  // namespace sunder::tear
