#pragma once

#include <sunder/core/character.h>

#include <string>
#include <vector>

namespace sunder::test {

/// A skeleton without meshes: a chain of `count` bones along y, each a metre long.
inline Character make_bare_chain(std::uint32_t count) {
  Character rig;
  rig.name = "chain";
  for (std::uint32_t i = 0; i < count; ++i) {
    Bone bone;
    bone.name = "link" + std::to_string(i);
    bone.parent = i == 0 ? kNone : i - 1;
    if (i > 0) bone.rest.translation = {0, 1, 0};
    rig.skeleton.bones.push_back(bone);
  }
  return rig;
}

/// The same meshes attached to one node, so that nothing is left of their rig.
inline Character without_rig(Character character) {
  Bone node;
  node.name = "node";
  character.skeleton.bones = {node};
  character.skins = {{"node", {0}, {Affine3f::Identity()}}};
  character.clips.clear();
  const std::vector<Influence> all = {{0, 1.0f}};
  for (Mesh& mesh : character.meshes) {
    mesh.skin = 0;
    mesh.weights = {};
    for (Index v = 0; v < mesh.vertex_count(); ++v) mesh.weights.append(all);
  }
  return character;
}

}  // namespace sunder::test
