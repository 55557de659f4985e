#pragma once

#include <span>

#include <assimp/scene.h>

#include "io/assimp/convert_meshes.h"
#include "io/assimp/scene_tree.h"

namespace sunder::assimp_import {

/// Writes every animation that has channels: node transforms and morph weights, linear, in seconds.
/// Keys that are not later than the previous one, lie before zero or are not finite are dropped;
/// keys are never sorted. A key that repeats the time and the value of the previous one is not
/// noted.
void convert_animations(const aiScene& scene, const SceneTree& tree,
                        std::span<const MorphedNode> morphed, GlbBuilder& glb, Notes& notes);

}  // namespace sunder::assimp_import
