#include "tear/bodies/internal/posed_surface.h"

#include "skinning/internal/character_pose.h"
#include "tear/bodies/internal/main_bones.h"

namespace sunder::bodies {

Result<PosedSurface> pose_surface(const Character& character, const ModelPose& pose) {
  CharacterPose posed;
  if (Status status = posed.set(character, pose); !status) return status;
  PosedSurface surface;
  for (const Mesh& mesh : character.meshes) {
    const Skin& skin = character.skins[mesh.skin];
    const auto first = static_cast<std::uint32_t>(surface.positions.size());
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      surface.positions.push_back(posed.position(mesh, v));
    MainBones main_bones(skin.bones.size());
    for (const Triangle& triangle : mesh.triangles) {
      surface.triangles.push_back({triangle[0] + first, triangle[1] + first, triangle[2] + first});
      surface.bones.push_back(is_retired(triangle) ? kNone
                                                   : main_bones.of(triangle, mesh.weights, skin));
    }
  }
  return surface;
}

}  // namespace sunder::bodies
