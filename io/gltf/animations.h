#pragma once

#include <sunder/core/clip.h>

#include <vector>

#include "io/gltf/meshes.h"

namespace sunder::gltf {

/// One clip an animation of the file, in its order. A channel that cannot be used is dropped, and
/// noted.
[[nodiscard]] std::vector<Clip> read_animations(Reading& reading, const NodeSkeleton& nodes,
                                                const std::vector<MorphRange>& morphs_of_node);

}  // namespace sunder::gltf
