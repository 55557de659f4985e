#pragma once

#include <sunder/core/character.h>
#include <sunder/skinning/deform.h>

#include <vector>

#include "tools/model/posed_model.h"

namespace sunder::tools {

/// Where a bone is in a pose, and the surface that it moves predominantly: the vertices for which
/// no other bone has a greater weight. Model space, metres.
struct BoneExtent {
  Vec3d joint = Vec3d::Zero();  ///< Its origin.
  /// The child that the bone leads to: of those at some distance that lead to surface, the one
  /// whose branch moves most vertices; kNone if there is none.
  std::uint32_t leads_to = kNone;
  /// To the joint of that child; otherwise from the joint to the farthest vertex it moves.
  double length = 0;
  std::uint32_t vertices = 0;
  std::uint32_t vertices_of_branch = 0;  ///< With those of all bones below it.
  Bounds bounds;                         ///< Of its vertices.
};

/// One entry per bone of the skeleton. @param posed  the meshes in that pose.
[[nodiscard]] std::vector<BoneExtent> measure_bones(const Character& character,
                                                    const ModelPose& pose,
                                                    const std::vector<DeformedMesh>& posed);

/// Per vertex, the bone with the greatest weight; of several, the one named first. kNone for
/// vertices that no triangle uses.
[[nodiscard]] std::vector<std::uint32_t> predominant_bones(const Skin& skin, const Mesh& mesh);

}  // namespace sunder::tools
