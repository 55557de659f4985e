#pragma once

#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

struct JoinedMeshes {
  Surface surface;                    ///< As build_surface() makes it; is_shared_vertex is empty.
  std::vector<Index> points_of_mesh;  ///< The points that each mesh would have alone, if used by a
                                      ///< triangle that is not retired.
};

/// O(vertices + triangles), deterministic.
[[nodiscard]] JoinedMeshes join_meshes(const Character& character);

}  // namespace sunder::tear
