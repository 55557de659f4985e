#pragma once

#include <sunder/core/character.h>

#include <vector>

#include "io/gltf_read/reading.h"
#include "io/gltf_read/skeleton.h"

namespace sunder::gltf {

/// The range in Pose::morph_weights that the meshes of a node share.
struct MorphRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

struct ReadMeshes {
  std::vector<SourceDocument::MeshOrigin> origins;  ///< One a mesh.
  std::vector<MorphRange> morphs_of_node;           ///< One per node of the file.
  std::vector<StoredInfluences> stored;             ///< One per mesh, if they are kept.
  std::vector<SourceDocument::RepairedSkin> repaired_skins;
};

/// Appends the scene's meshes, their skins and rest morph weights to the character.
[[nodiscard]] ReadMeshes read_meshes(Reading& reading, const NodeSkeleton& nodes,
                                     Character& character);

}  // namespace sunder::gltf
