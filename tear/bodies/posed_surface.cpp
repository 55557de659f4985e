#include "tear/bodies/internal/posed_surface.h"

#include <utility>

#include "core/internal/ordered.h"
#include "skinning/internal/character_pose.h"
#include "tear/bodies/internal/main_bones.h"

namespace sunder::bodies {
namespace {

/// Per bone: whether its matrix in the palette mirrors, so that its triangles look inwards.
std::vector<bool> mirrored_bones(const Skin& skin, const std::vector<Affine3d>& palette,
                                 std::size_t bone_count) {
  std::vector<bool> mirrored(bone_count, false);
  for (std::size_t slot = 0; slot < skin.bones.size(); ++slot)
    if (determinant(Mat3d(palette[slot].linear())) < 0.0) mirrored[skin.bones[slot]] = true;
  return mirrored;
}

}  // namespace

Result<PosedSurface> pose_surface(const Character& character, const ModelPose& pose) {
  CharacterPose posed;
  if (Status status = posed.set(character, pose); !status) return status;
  PosedSurface surface;
  for (const Mesh& mesh : character.meshes) {
    const Skin& skin = character.skins[mesh.skin];
    const auto first = static_cast<std::uint32_t>(surface.positions.size());
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      surface.positions.push_back(posed.position(mesh, v));
    const std::vector<bool> mirrored =
        mirrored_bones(skin, posed.palette(mesh.skin), character.skeleton.bones.size());
    MainBones main_bones(skin.bones.size());
    for (const Triangle& triangle : mesh.triangles) {
      surface.bones.push_back(is_retired(triangle) ? kNone
                                                   : main_bones.of(triangle, mesh.weights, skin));
      Triangle moved = {triangle[0] + first, triangle[1] + first, triangle[2] + first};
      if (surface.bones.back() != kNone && mirrored[surface.bones.back()])
        std::swap(moved[1], moved[2]);
      surface.triangles.push_back(moved);
    }
  }
  return surface;
}

}  // namespace sunder::bodies
