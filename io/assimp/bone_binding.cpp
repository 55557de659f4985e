#include "io/assimp/bone_binding.h"

#include <map>

#include <Eigen/LU>

namespace sunder::assimp_import {
namespace {

/// The bone_from_mesh with which a bone at `model_from_bone` keeps the mesh where its own node
/// places it.
Mat4d offset_at_rest(const Mat4d& model_from_bone, const Mat4d& model_from_mesh) {
  if (!is_usable_bind(model_from_bone)) return Mat4d::Identity();
  return model_from_bone.inverse() * model_from_mesh;
}

}  // namespace

std::vector<BoneBinding> bind_bones(const aiMesh& mesh, std::uint32_t mesh_node,
                                    const std::string& place, SceneTree& tree, Notes& notes) {
  std::vector<BoneBinding> bindings(mesh.mNumBones);
  std::map<std::uint32_t, Mat4f> offset_of_node;
  for (unsigned i = 0; i < mesh.mNumBones; ++i) {
    if (mesh.mBones[i] == nullptr) continue;
    const aiBone& bone = *mesh.mBones[i];
    BoneBinding& binding = bindings[i];
    const Mat4d model_from_mesh = tree[mesh_node].model_from_node;
    Mat4d offset = to_eigen(bone.mOffsetMatrix);
    const bool usable = is_usable_bind(offset);

    binding.node = tree.find_bone(mesh_node, bone.mName);
    if (binding.node == kNone) {
      const Mat4d model_from_bone =
          usable ? Mat4d(model_from_mesh * offset.inverse()) : model_from_mesh;
      const Mat4d model_from_root = tree[0].model_from_node;
      const Mat4d root_from_bone = is_usable_bind(model_from_root)
                                       ? Mat4d(model_from_root.inverse() * model_from_bone)
                                       : model_from_bone;
      binding.node = tree.add(0, valid_utf8(to_string(bone.mName)), root_from_bone, &bone.mName);
      notes.repaired(StatusCode::not_found, place,
                     "bones without a node of the same name; added below the root");
    }
    if (!usable) {
      offset = offset_at_rest(tree[binding.node].model_from_node, model_from_mesh);
      notes.repaired(
          StatusCode::malformed_file, place,
          "bind matrices not finite, affine and invertible; recomputed from the rest pose");
    }
    offset.row(3) << 0.0, 0.0, 0.0, 1.0;
    binding.bone_from_mesh = offset.cast<float>();

    const auto [known, is_new] = offset_of_node.emplace(binding.node, binding.bone_from_mesh);
    if (!is_new && known->second != binding.bone_from_mesh) {
      notes.repaired(StatusCode::malformed_file, place,
                     "bones of the same name with different bind matrices; the first one is used");
      binding.bone_from_mesh = known->second;
    }
  }
  return bindings;
}

}  // namespace sunder::assimp_import
