#pragma once

#include "tear/internal/surface.h"

namespace sunder::tear {

/// A surface, and whether any of its points had vertices of two meshes before each fan got a point
/// of its own. If none had, the surface of each mesh alone is a part of it.
struct JoinedMeshes {
  Surface surface;
  bool share_points = false;
};

/// The same surface as build_surface(). O(vertices + triangles), deterministic.
[[nodiscard]] JoinedMeshes join_meshes(const Character& character);

}  // namespace sunder::tear
