#pragma once

#include <string>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

// The steps of making walls and caps; their vertices come from Births.

/// @return the index of the new submesh.
[[nodiscard]] Index append_submesh(Index mesh, const std::string& name, Index material,
                                   SurfaceEditor& editor);

/// Appends a point of a wall or cap. @return the point, which has no corner yet.
[[nodiscard]] Index append_filling_point(SurfaceEditor& editor);

/// Appends a triangle that no triangle of the source covers. It is not connected, see connect().
/// @return the triangle of the surface.
Index append_filling(Index mesh, Index submesh, const std::array<Index, 3>& points,
                     const Triangle& vertices, SurfaceEditor& editor);

/// Joins two border half-edges that run between the same points in opposite directions.
void connect(Index a, Index b, SurfaceEditor& editor);

}  // namespace sunder::tear
