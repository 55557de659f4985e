#pragma once

#include <string>
#include <vector>

#include <assimp/scene.h>

#include "io/assimp/materials.h"
#include "io/assimp/scene_tree.h"

namespace sunder::assimp_import {

/// A node whose mesh has morph targets; used to convert animations.
struct MorphedNode {
  std::uint32_t node = 0;
  std::string source_name;  ///< The node of the file that has the mesh.
  std::uint32_t target_count = 0;
};

/// Writes the meshes of all nodes, with their skins: one glTF mesh per node, one primitive per
/// aiMesh. Meshes of one node that have different skins or morph targets are written on child
/// nodes.
/// @return the nodes with morph targets.
std::vector<MorphedNode> convert_meshes(const aiScene& scene,
                                        const std::vector<bool>& is_de_indexed,
                                        const std::string& extension, SceneTree& tree,
                                        MaterialWriter& materials, GlbBuilder& glb, Notes& notes);

}  // namespace sunder::assimp_import
