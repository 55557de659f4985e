#pragma once

#include <vector>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Turns edges within source triangles where that makes the worst of the two faces' shape better,
/// until none does. The surface stays what it is, lips and borders too.
/// @param faces  where to look first.
/// O(faces + edges turned).
void improve_faces(const EditLog::Mark& since, SurfaceEditor& editor);

}  // namespace sunder::tear
