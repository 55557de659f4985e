#include "aim/limb_bones.h"

namespace sunder::aim {
namespace {

/// Whether a bone belongs to the limb of a bone above it. Where that is the one on which all hang,
/// a bone that hangs on it by the surface alone begins a limb of its own.
bool is_of_limb(const BoneTree& tree, Index bone, Index top) {
  if (!tree.is_below(bone, top)) return false;
  if (tree.parent(top) != kNone) return true;
  for (; bone != top; bone = tree.parent(bone))
    if (tree.is_adopted(bone)) return false;
  return true;
}

}  // namespace

LimbBones::LimbBones(const PosedSurface& surface, const BoneTree& tree, Index bone)
    : surface_(surface), bone_(bone), parent_(tree.moving_parent(bone)) {
  const Skeleton& skeleton = surface.character().skeleton;
  roles_.assign(skeleton.bones.size(), BoneRole::other);
  for (Index above = parent_; above != kNone; above = tree.parent(above))
    roles_[above] = above == parent_ ? BoneRole::parent : BoneRole::above;
  const std::vector<Index> own = tree.same_bones(skeleton, bone);
  for (const Index top : own)
    for (Index i = 0; i < roles_.size(); ++i)
      if (is_of_limb(tree, i, top)) roles_[i] = BoneRole::below;
  for (const Index top : own) roles_[top] = BoneRole::own;
}

LimbShares LimbBones::shares(Index point) const {
  LimbShares shares;
  for_each_influence(surface_, point, [&](Index bone, double weight) {
    shares.of_role[static_cast<std::size_t>(roles_[bone])] += weight;
  });
  return shares;
}

LimbShares LimbBones::shares_of_face(Index face) const {
  LimbShares mean;
  for (Index corner = 3 * face; corner < 3 * face + 3; ++corner)
    mean.add(shares(surface_.point(corner)), 1.0 / 3);
  return mean;
}

}  // namespace sunder::aim
