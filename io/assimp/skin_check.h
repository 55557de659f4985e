#pragma once

#include <span>
#include <string>

#include "io/assimp/mesh_part.h"
#include "io/assimp/scene_tree.h"

namespace sunder::assimp_import {

/// The bones of a mesh's skin; influences name slots.
struct SkinSlots {
  std::vector<std::uint32_t> nodes;
  std::vector<Mat4f> bone_from_mesh;  ///< At bind.
};

/// Measures a skin on the mesh that it moves and notes: how exactly the skin, posed at bind,
/// reproduces the mesh; whether the file's rest pose is another; whether the skin puts the mesh
/// elsewhere than the mesh's own node would (it is the skin that counts).
void check_skin(const SkinSlots& skin, std::span<const MeshPart> parts, std::uint32_t mesh_node,
                const std::string& place, const SceneTree& tree, Notes& notes);

}  // namespace sunder::assimp_import
