#pragma once

#include <sunder/core/clip.h>

#include <vector>

#include "io/gltf_read/meshes.h"

namespace sunder::gltf {

/// One clip per animation, in the file's order. Unusable channels are dropped, with a note.
[[nodiscard]] std::vector<Clip> read_animations(Reading& reading, const NodeSkeleton& nodes,
                                                const std::vector<MorphRange>& morphs_of_node);

}  // namespace sunder::gltf
