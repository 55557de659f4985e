#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// The faces connected with `face` across edges, ascending. O(faces), and two bits
/// per face of the surface. @throws std::bad_alloc
[[nodiscard]] std::vector<Index> connected_faces(Index face, const Surface& surface);

/// Whether the surface has a face that is not among `faces`, which are ascending. O(faces), and
/// O(retired faces) at the start of the surface.
[[nodiscard]] bool has_others(const std::vector<Index>& faces, const Surface& surface);

/// Retires all faces of a connected component. Their points keep their indices and have no corner.
/// @throws CapacityExceeded, std::bad_alloc, before anything changes
void retire_component(const std::vector<Index>& faces, SurfaceEditor& editor);

}  // namespace sunder::tear
