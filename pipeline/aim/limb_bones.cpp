#include "pipeline/aim/limb_bones.h"

#include "pipeline/aim/limb_extent.h"

namespace sunder::aim {
LimbBones::LimbBones(const PosedSurface& surface, const BoneTree& tree, Index bone)
    : surface_(surface), bone_(bone), parent_(tree.moving_parent(bone)) {
  const Skeleton& skeleton = surface.character().skeleton;
  roles_.assign(skeleton.bones.size(), BoneRole::other);
  for (Index above = parent_; above != kNone; above = tree.parent(above))
    roles_[above] = above == parent_ ? BoneRole::parent : BoneRole::above;
  const std::vector<bool> is_of_limb = bones_of_limb(surface, tree, bone);
  for (Index i = 0; i < roles_.size(); ++i)
    if (is_of_limb[i]) roles_[i] = BoneRole::below;
  for (const Index top : tree.same_bones(skeleton, bone)) roles_[top] = BoneRole::own;
  for (Index i = 0; i < roles_.size(); ++i) {
    const Index above = tree.parent(i);
    const bool is_of_same =
        roles_[i] == BoneRole::other && above != kNone && roles_[above] == BoneRole::other;
    other_above_.push_back(is_of_same ? above : kNone);
  }
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
