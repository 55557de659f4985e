#pragma once

#include <vector>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Flips edges between parts of one origin while this improves the shape of the worse of the two
/// faces. The shape of the surface, lips and borders do not change.
/// @param since  starts with faces that changed since this mark. O(faces + edges flipped).
void improve_faces(const EditLog::Mark& since, SurfaceEditor& editor);

}  // namespace sunder::tear
