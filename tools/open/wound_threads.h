#pragma once

#include <sunder/particles/soft_body.h>

#include <span>
#include <vector>

#include "tools/open/wound_walls.h"

namespace sunder::tools {

/// The stitches of sutures as parts of meshes: each half has the weights of its lip, in all poses,
/// or both halves those of the left lip, if the lips are of two meshes. Broken threads are left
/// out.
/// @param torn          of which `closed` and `open` are poses, with normals.
/// @param closed, open  as Opening's.
/// @param loads         of the threads.
[[nodiscard]] WoundWalls make_wound_threads(const TornModel& torn,
                                            std::span<const ThreadLoad> loads,
                                            const std::vector<DeformedMesh>& closed,
                                            const std::vector<DeformedMesh>& open);

}  // namespace sunder::tools
