#pragma once

#include <string>
#include <vector>

#include <assimp/mesh.h>

#include "io/assimp/notes.h"
#include "io/assimp/scene_tree.h"
#include "io/assimp/transform.h"

namespace sunder::assimp_import {

/// The content of one aiBone: the node that moves its vertices, and that node's transform at the
/// time of binding.
struct BoneBinding {
  std::uint32_t node = kNone;
  Mat4f bone_from_mesh = Mat4f::Identity();
};

/// One entry per bone of the mesh. Bones are found by name. If there is no such node, one is added
/// below the root, where it leaves the mesh unchanged. Offsets that are not finite, affine and
/// invertible are recomputed from the file's rest pose.
[[nodiscard]] std::vector<BoneBinding> bind_bones(const aiMesh& mesh, std::uint32_t mesh_node,
                                                  const std::string& place, SceneTree& tree,
                                                  Notes& notes);

}  // namespace sunder::assimp_import
