#pragma once

#include <vector>

#include "pipeline/aim/posed_surface.h"

namespace sunder::aim {

/// Joints nearer than this share of the model's size are one place.
constexpr double kSameJointSizes = 1e-5;

/// How much surface a bone moves together with another one.
struct SharedBone {
  Index bone = 0;
  double amount = 0;
};

/// The bones as a tree that follows the surface. It is that of the skeleton, except that a bone
/// whose surface does not adjoin that of any bone above it hangs on the bone that it shares most
/// surface with: the foot of a rig for inverse kinematics, which the skeleton hangs on the root, on
/// the leg; the fingers of a flat list of bones on the hand. A bone that keeps its place goes
/// before one that does not, unless it shares much less.
class BoneTree {
 public:
  /// O(faces x influences squared + bones squared).
  explicit BoneTree(const PosedSurface& surface);

  [[nodiscard]] Index parent(Index bone) const { return parents_[bone]; }
  /// Whether the bone hangs on another bone than in the skeleton.
  [[nodiscard]] bool is_adopted(Index bone) const { return is_adopted_[bone]; }
  /// Sum of the bone's weights over all points.
  [[nodiscard]] double weight(Index bone) const { return weights_[bone]; }
  [[nodiscard]] bool moves(Index bone) const { return weights_[bone] > 0; }
  [[nodiscard]] bool is_below(Index bone, Index top) const;
  [[nodiscard]] const std::vector<Index>& children(Index bone) const { return children_[bone]; }
  /// The bones with which a bone shares surface, ascending: per pair, the sum over all faces of the
  /// products of their weights.
  [[nodiscard]] const std::vector<SharedBone>& shared(Index bone) const { return shared_[bone]; }
  /// The nearest bone above that moves something; kNone if there is none.
  [[nodiscard]] Index moving_parent(Index bone) const;
  /// A bone and those that have its parent and its rest transform: parts of one limb that a file
  /// splits by material. For a bone that moves nothing, also its children in the same place, and
  /// those that are parts of it: rigid, without bones below them, and moved by no clip.
  [[nodiscard]] std::vector<Index> same_bones(const Skeleton& skeleton, Index bone) const;
  /// Whether a bone moves nothing itself, but by rigid parts elsewhere, see same_bones().
  [[nodiscard]] bool is_made_of_parts(const Skeleton& skeleton, Index bone) const;

 private:
  std::vector<Index> parents_;
  std::vector<bool> is_adopted_;
  std::vector<std::vector<Index>> children_;
  std::vector<double> weights_;
  std::vector<bool> is_rigid_part_;
  std::vector<std::vector<SharedBone>> shared_;  ///< Per bone.
};

/// Calls visit(bone, weight) for the influences of a point.
template <class Visit>
void for_each_influence(const PosedSurface& surface, Index point, Visit visit) {
  const auto [mesh, vertex] = surface.vertex(point);
  if (mesh == kNone) return;
  const Mesh& of = surface.character().meshes[mesh];
  const Skin& skin = surface.character().skins[of.skin];
  for (const Influence& influence : of.weights.of(vertex))
    visit(skin.bones[influence.slot], static_cast<double>(influence.weight));
}

}  // namespace sunder::aim
