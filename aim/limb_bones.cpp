#include "aim/limb_bones.h"

namespace sunder::aim {

LimbBones::LimbBones(const PosedSurface& surface, const BoneTree& tree, Index bone)
    : surface_(surface), bone_(bone) {
  const Skeleton& skeleton = surface.character().skeleton;
  roles_.assign(skeleton.bones.size(), BoneRole::other);
  if (const Index parent = tree.moving_parent(bone); parent != kNone)
    for (Index above = parent; above != kNone; above = tree.parent(above))
      roles_[above] = above == parent ? BoneRole::parent : BoneRole::above;
  const std::vector<Index> own = tree.same_bones(skeleton, bone);
  for (const Index top : own)
    for (Index i = 0; i < roles_.size(); ++i)
      if (tree.is_below(i, top)) roles_[i] = BoneRole::below;
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
