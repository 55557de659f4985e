#include "pipeline/ragdoll/rigid_parts.h"

#include "core/internal/moved_bones.h"

namespace sunder::ragdoll {

std::vector<std::uint32_t> owners_of_parts(const Character& character,
                                           std::span<const std::uint32_t> bone_of_triangle) {
  const std::vector<Bone>& bones = character.skeleton.bones;
  const auto count = static_cast<std::uint32_t>(bones.size());
  std::vector<bool> moves_surface(count, false), is_skinned(count, false);
  for (const std::uint32_t bone : bone_of_triangle)
    if (bone != kNone) moves_surface[bone] = true;
  for (const Mesh& mesh : character.meshes)
    if (const Skin& skin = character.skins[mesh.skin]; skin.bones.size() > 1)
      for (const std::uint32_t bone : skin.bones) is_skinned[bone] = true;
  std::vector<std::uint32_t> bones_below(count, 0);
  for (const Bone& bone : bones)
    if (bone.parent != kNone) ++bones_below[bone.parent];

  const std::vector<bool> is_animated = bones_moved_by_clips(character);
  std::vector<bool> is_part = moves_surface;
  std::vector<std::uint32_t> owners(count);
  for (std::uint32_t bone = 0; bone < count; ++bone) owners[bone] = bone;
  for (std::uint32_t bone = count; bone-- > 0;) {
    const std::uint32_t parent = bones[bone].parent;
    if (parent == kNone || !is_part[bone] || is_skinned[bone] || is_animated[bone] ||
        bones_below[bone] > 0 || moves_surface[parent])
      continue;
    owners[bone] = parent;
    --bones_below[parent];
    if (!character.clips.empty()) is_part[parent] = true;
  }
  for (std::uint32_t bone = 0; bone < count; ++bone) owners[bone] = owners[owners[bone]];
  return owners;
}

}  // namespace sunder::ragdoll
