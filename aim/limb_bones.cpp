#include "aim/limb_bones.h"

namespace sunder::aim {

LimbBones::LimbBones(const PosedSurface& surface, const std::vector<double>& weights, Index bone)
    : surface_(surface), bone_(bone) {
  const auto& bones = surface.character().skeleton.bones;
  roles_.assign(bones.size(), BoneRole::other);
  roles_[bone] = BoneRole::own;
  for (Index i = bone + 1; i < bones.size(); ++i) {  // parents come before children
    const Index parent = bones[i].parent;
    if (parent != kNone && (roles_[parent] == BoneRole::own || roles_[parent] == BoneRole::below))
      roles_[i] = BoneRole::below;
  }
  Index parent = bones[bone].parent;
  while (parent != kNone && !(weights[parent] > 0)) parent = bones[parent].parent;
  if (parent != kNone) roles_[parent] = BoneRole::parent;
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

std::vector<double> bone_weights(const PosedSurface& surface) {
  std::vector<double> weights(surface.character().skeleton.bones.size(), 0.0);
  for (Index point = 0; point < surface.surface().point_count(); ++point)
    for_each_influence(surface, point, [&](Index bone, double weight) { weights[bone] += weight; });
  return weights;
}

}  // namespace sunder::aim
