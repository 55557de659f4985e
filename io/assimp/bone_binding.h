#pragma once

#include <string>
#include <vector>

#include <assimp/mesh.h>

#include "io/assimp/notes.h"
#include "io/assimp/scene_tree.h"
#include "io/assimp/transform.h"

namespace sunder::assimp_import {

/// The content of one aiBone: the node that moves its vertices, and where that node was when they
/// were attached.
struct BoneBinding {
  std::uint32_t node = kNone;
  Mat4f bone_from_mesh = Mat4f::Identity();
};

/// One a bone of the mesh. Bones are found by name; one without a node gets one, below the root,
/// where it leaves the mesh as it is. Offsets that are not finite, affine and invertible are
/// recomputed from the file's rest pose.
[[nodiscard]] std::vector<BoneBinding> bind_bones(const aiMesh& mesh, std::uint32_t mesh_node,
                                                  const std::string& place, SceneTree& tree,
                                                  Notes& notes);

}  // namespace sunder::assimp_import
