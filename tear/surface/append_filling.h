#pragma once

#include <string>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

// The steps of making walls and caps; their vertices come from Births.

/// As Fillings::find_or_append_submesh().
[[nodiscard]] Index submesh_of_fillings(Index mesh, const std::string& name, Index material,
                                        SurfaceEditor& editor);

/// Where fillings that are made together go.
struct FillingSubmesh {
  Index mesh, submesh;
  Index group;  ///< See FillingGroup.
};

/// Appends a point of a wall or cap. @return the point, which has no corner yet.
[[nodiscard]] Index append_filling_point(SurfaceEditor& editor);

/// Appends a triangle that no triangle of the source covers. It is not connected, see connect().
/// @return the triangle of the surface.
Index append_filling(const FillingSubmesh& to, const std::array<Index, 3>& points,
                     const Triangle& vertices, SurfaceEditor& editor);

/// Joins two border half-edges that run between the same points in opposite directions.
void connect(Index a, Index b, SurfaceEditor& editor);

}  // namespace sunder::tear
