#pragma once

#include <sunder/core/character.h>

#include <vector>

#include "pipeline/validation/internal/weight_row.h"
#include "pipeline/validation/match/bone_match.h"

namespace sunder::validation {

/// The bones that move the target after a transfer.
struct TargetBones {
  Skeleton skeleton;  ///< The target's; bones of the source that it adopts follow.
  std::vector<Affine3d> model_from_bone;  ///< At bind, per bone.
  /// Per bone of the source: the bone that takes its weight. Its counterpart, else that of its
  /// nearest ancestor that has one, else the first counterpart of all.
  std::vector<Index> of_source;
  std::vector<Index> counterparts;  ///< Per bone of the source, the same bone; kNone: none.
  std::vector<Index> lost;          ///< Bones of the source with weight but without counterpart.
  bool has_adopted = false;
};

/// The target keeps its skeleton if any bone that moves its vertices is the counterpart of one that
/// moves the source's; otherwise it adopts all bones of the source's skins with their ancestors.
[[nodiscard]] TargetBones choose_bones(const Character& source, const Character& target,
                                       const BoneMatch& match);

/// The weights of each vertex of a mesh on the bones of its skeleton, normalised.
/// @param bone_of  per bone of the character: the bone to count it for; empty: itself.
[[nodiscard]] std::vector<WeightRow> rows_of(const Character& character, Index mesh,
                                             const std::vector<Index>& bone_of);

/// Writes weights into the meshes of a target. A skin that has all bones wanted stays; meshes of
/// another one get a skin with those that it lacks, one for all of them.
/// @param rows  per mesh and vertex; an empty row keeps the vertex as it is.
void write_rows(const TargetBones& bones, const std::vector<std::vector<WeightRow>>& rows,
                Character& character);

}  // namespace sunder::validation
