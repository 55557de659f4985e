#pragma once

#include <span>
#include <string>

#include "io/assimp/mesh_part.h"
#include "io/assimp/scene_tree.h"

namespace sunder::assimp_import {

/// The bones of a mesh's skin; influences refer to its slots.
struct SkinSlots {
  std::vector<std::uint32_t> nodes;
  std::vector<Mat4f> bone_from_mesh;  ///< At bind.
};

/// Measures a skin on its mesh and writes notes: how exactly the skin reproduces the mesh in the
/// bind pose; whether the rest pose of the file differs from it; whether the skin places the mesh
/// elsewhere than the mesh's own node (the skin is used).
void check_skin(const SkinSlots& skin, std::span<const MeshPart> parts, std::uint32_t mesh_node,
                const std::string& place, const SceneTree& tree, Notes& notes);

}  // namespace sunder::assimp_import
