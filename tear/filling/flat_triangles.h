#pragma once

#include <span>

#include "tear/filling/cap_rim.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

// Rim points that should be collinear, as where a cut meets an older cap, are so only approximately
// in the pose. After rounding to float, a triangle of three of them has no area in bind space.

/// The mesh of a cap, and its vertices by the numbers of its points.
struct CapVertices {
  Index mesh;
  std::span<const Index> vertices;
};

/// Whether stored positions leave a triangle no area, or nearly none.
[[nodiscard]] bool has_flat_triangles(std::span<const FlatTriangle> triangles,
                                      const CapVertices& of, const SurfaceEditor& editor);
/// Flips the longest edges of such triangles. @return false if triangles without area are left:
/// stored positions are too coarse.
[[nodiscard]] bool turn_flat_triangles(std::span<FlatTriangle> triangles, const CapVertices& of,
                                       const CapRim& rim, const SurfaceEditor& editor);

}  // namespace sunder::tear
