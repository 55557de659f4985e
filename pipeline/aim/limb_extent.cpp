#include "pipeline/aim/limb_extent.h"

#include <utility>

namespace sunder::aim {
namespace {

/// A bone belongs to a limb if it and all that hang on it share with the limb at least so much of
/// the surface that they share with any.
constexpr double kLeastOwnSurface = 0.8;

/// A bone with all that hang on it.
std::vector<Index> branch_of(const BoneTree& tree, Index top) {
  std::vector<Index> branch = {top};
  for (std::size_t i = 0; i < branch.size(); ++i)
    for (const Index child : tree.children(branch[i])) branch.push_back(child);
  return branch;
}

/// The bone with the parts of it, and all that hang on them in the skeleton, but for those whose
/// surface hangs elsewhere.
std::vector<bool> skeletons_branch(const PosedSurface& surface, const BoneTree& tree, Index bone) {
  const Skeleton& skeleton = surface.character().skeleton;
  std::vector<bool> is_of_branch(skeleton.bones.size(), false);
  for (const Index same : tree.same_bones(skeleton, bone)) is_of_branch[same] = true;
  for (Index i = 0; i < is_of_branch.size(); ++i) {  // parents come before children
    const Index parent = skeleton.bones[i].parent;
    if (parent != kNone && is_of_branch[parent] && !tree.is_adopted(i)) is_of_branch[i] = true;
  }
  return is_of_branch;
}

class Extent {
 public:
  Extent(const BoneTree& tree, std::vector<bool> is_of_limb)
      : tree_(tree), is_of_limb_(std::move(is_of_limb)), is_of_branch_(is_of_limb_.size(), false) {
    for (Index i = 0; i < is_of_limb_.size(); ++i)
      if (is_of_limb_[i]) weight_ += tree.weight(i);
  }

  /// Takes in a bone with all that hang on it if they adjoin hardly any but the limb. What the
  /// skeleton hangs elsewhere, on a bone that it adjoins, is a part of the limb only if it is not
  /// larger: a thumb, but not the head behind a bone that rounds the neck.
  bool take_in(Index top) {
    const std::vector<Index> branch = branch_of(tree_, top);
    for (const Index bone : branch) is_of_branch_[bone] = true;
    double with_limb = 0, with_others = 0, weight = 0;
    for (const Index bone : branch) {
      if (is_of_limb_[bone]) continue;
      weight += tree_.weight(bone);
      for (const SharedBone& shared : tree_.shared(bone))
        if (is_of_limb_[shared.bone])
          with_limb += shared.amount;
        else if (!is_of_branch_[shared.bone])
          with_others += shared.amount;
    }
    const bool is_part = tree_.is_adopted(top) || weight <= weight_;
    const bool is_of_limb =
        is_part && with_limb > 0 && with_limb >= kLeastOwnSurface * (with_limb + with_others);
    for (const Index bone : branch) {
      is_of_branch_[bone] = false;
      if (is_of_limb) is_of_limb_[bone] = true;
    }
    if (is_of_limb) weight_ += weight;
    return is_of_limb;
  }
  [[nodiscard]] const std::vector<bool>& is_of_limb() const { return is_of_limb_; }

 private:
  const BoneTree& tree_;
  std::vector<bool> is_of_limb_, is_of_branch_;
  double weight_ = 0;  ///< Of the limb.
};

}  // namespace

std::vector<bool> bones_of_limb(const PosedSurface& surface, const BoneTree& tree, Index bone) {
  Extent extent(tree, skeletons_branch(surface, tree, bone));
  if (tree.parent(bone) == kNone) return extent.is_of_limb();
  const auto count = static_cast<Index>(extent.is_of_limb().size());
  std::vector<bool> is_above(count, false);
  for (Index i = tree.parent(bone); i != kNone; i = tree.parent(i)) is_above[i] = true;
  for (bool has_grown = true; std::exchange(has_grown, false);)
    for (Index i = 0; i < count; ++i)
      if (!is_above[i] && !extent.is_of_limb()[i] && extent.take_in(i)) has_grown = true;
  return extent.is_of_limb();
}

}  // namespace sunder::aim
