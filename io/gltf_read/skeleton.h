#pragma once

#include <sunder/core/skeleton.h>

#include <vector>

#include "io/gltf_read/reading.h"

namespace sunder::gltf {

struct NodeSkeleton {
  Skeleton skeleton;
  std::vector<std::uint32_t> bone_from_node;  ///< kNone for nodes outside the scene.
  std::vector<std::uint32_t> scene_nodes;     ///< Nodes of the scene, parents first.
};

/// The nodes of the default scene as bones, and the trees outside it that contain joints of its
/// skins.
[[nodiscard]] NodeSkeleton read_skeleton(Reading& reading);

}  // namespace sunder::gltf
