#include "pipeline/aim/bone_tree.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>

#include "pipeline/aim/joined_sets.h"

namespace sunder::aim {
namespace {

/// How much surface each two bones move together: the sum over all faces of the products of their
/// weights.
class SharedSurface {
 public:
  explicit SharedSurface(const PosedSurface& surface) {
    std::vector<std::pair<Index, double>> of_face;
    for (Index face = 0; face < surface.face_count(); ++face) {
      if (!surface.is_live(face)) continue;
      of_face.clear();
      for (Index corner = 3 * face; corner < 3 * face + 3; ++corner)
        for_each_influence(surface, surface.point(corner), [&](Index bone, double weight) {
          const auto known = std::find_if(of_face.begin(), of_face.end(),
                                          [&](const auto& entry) { return entry.first == bone; });
          if (known == of_face.end())
            of_face.emplace_back(bone, weight);
          else
            known->second += weight;
        });
      for (std::size_t i = 0; i < of_face.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          shared_[key(of_face[i].first, of_face[j].first)] += of_face[i].second * of_face[j].second;
    }
  }

  [[nodiscard]] double of(Index a, Index b) const {
    const auto found = shared_.find(key(a, b));
    return found == shared_.end() ? 0.0 : found->second;
  }

  /// Per bone, those with which it shares surface, ascending.
  [[nodiscard]] std::vector<std::vector<SharedBone>> by_bone(std::size_t bone_count) const {
    std::vector<std::vector<SharedBone>> lists(bone_count);
    for (const auto& [pair, amount] : shared_) {  // the order of the map does not matter: sorted
      const auto a = static_cast<Index>(pair >> 32), b = static_cast<Index>(pair);
      lists[a].push_back({b, amount});
      lists[b].push_back({a, amount});
    }
    for (std::vector<SharedBone>& list : lists) std::ranges::sort(list, {}, &SharedBone::bone);
    return lists;
  }

 private:
  static std::uint64_t key(Index a, Index b) {
    return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
  }
  std::unordered_map<std::uint64_t, double> shared_;
};

/// The bones that move something and hang on none that does, with all that hangs on each: the trees
/// of the skeleton.
class Trees {
 public:
  Trees(const std::vector<Bone>& bones, const std::vector<double>& weights)
      : root_of_(bones.size(), kNone), below_(weights) {
    for (Index i = 0; i < bones.size(); ++i) {  // parents come before children
      const Index above = bones[i].parent == kNone ? kNone : root_of_[bones[i].parent];
      root_of_[i] = above != kNone ? above : weights[i] > 0 ? i : kNone;
      if (root_of_[i] == i)
        roots_.push_back(i);
      else if (root_of_[i] != kNone)
        below_[root_of_[i]] += weights[i];
    }
  }

  [[nodiscard]] const std::vector<Index>& roots() const { return roots_; }
  [[nodiscard]] Index root_of(Index bone) const { return root_of_[bone]; }
  /// The weight of a root and of all that hangs on it.
  [[nodiscard]] double weight(Index root) const { return below_[root]; }
  [[nodiscard]] Index heaviest() const {
    Index heaviest = kNone;
    for (const Index root : roots_)
      if (heaviest == kNone || weight(root) > weight(heaviest)) heaviest = root;
    return heaviest;
  }
  [[nodiscard]] double whole() const {
    double sum = 0;
    for (const Index root : roots_) sum += weight(root);
    return sum;
  }

 private:
  std::vector<Index> root_of_;  ///< Per bone; kNone: nothing above it and not it itself moves.
  std::vector<double> below_;
  std::vector<Index> roots_;
};

/// The roots of the pairs of trees that adjoin, unless they share much less surface than the pair
/// that shares most.
std::vector<std::array<Index, 2>> adjoining_trees(const Trees& trees, const SharedSurface& shared,
                                                  Index bone_count) {
  constexpr double kLeastOfStrongestBond = 0.05;
  std::map<std::array<Index, 2>, double> by_pair;
  double strongest = 0;
  for (Index a = 0; a < bone_count; ++a)
    for (Index b = 0; b < a; ++b) {
      const Index i = trees.root_of(a), j = trees.root_of(b);
      if (i == kNone || j == kNone || i == j) continue;
      double& bond = by_pair[{std::min(i, j), std::max(i, j)}];
      bond += shared.of(a, b);
      strongest = std::max(strongest, bond);
    }
  std::vector<std::array<Index, 2>> pairs;
  for (const auto& [pair, bond] : by_pair)
    if (bond > 0 && bond >= kLeastOfStrongestBond * strongest) pairs.push_back(pair);
  return pairs;
}

/// Of the trees of a flat list of bones, the one in the middle: without it, the heaviest part of
/// the others that adjoin one another is lightest. Of several, the heaviest.
Index middle_tree(const Trees& trees, const std::vector<std::array<Index, 2>>& pairs,
                  Index bone_count) {
  Index middle = kNone;
  double least = 0;
  for (const Index root : trees.roots()) {
    JoinedSets joined(bone_count);
    for (const auto& [a, b] : pairs)
      if (a != root && b != root) joined.join(a, b);
    std::vector<double> parts(bone_count, 0.0);
    for (const Index other : trees.roots())
      if (other != root) parts[joined.set_of(other)] += trees.weight(other);
    const double heaviest = *std::ranges::max_element(parts);
    const bool is_better = middle == kNone || heaviest < least ||
                           (heaviest == least && trees.weight(root) > trees.weight(middle));
    if (!is_better) continue;
    middle = root;
    least = heaviest;
  }
  return middle;
}

/// The bone that most of the model hangs on, of those that move something and hang on none that
/// does. If on none hangs half of it, because the bones are a flat list, the one in the middle: the
/// body and not the head, whichever has more vertices.
Index main_root(const std::vector<Bone>& bones, const std::vector<double>& weights,
                const SharedSurface& shared) {
  constexpr double kMostOfModel = 0.5;
  const Trees trees(bones, weights);
  const Index heaviest = trees.heaviest();
  if (heaviest == kNone || trees.weight(heaviest) >= kMostOfModel * trees.whole()) return heaviest;
  const auto count = static_cast<Index>(bones.size());
  return middle_tree(trees, adjoining_trees(trees, shared, count), count);
}

/// A bone that keeps its place in the skeleton goes before the one with the strongest bond if its
/// own is at least so much of that.
constexpr double kLeastOfStrongest = 0.4;

/// Hangs bones whose surface adjoins no bone above them on the bone that they share most with,
/// those with the strongest bond first.
class Adoption {
 public:
  Adoption(const PosedSurface& surface, const std::vector<double>& weights,
           const SharedSurface& shared, std::vector<Index>& parents)
      : surface_(surface), shared_(shared), parents_(parents) {
    const std::vector<Bone>& bones = surface.character().skeleton.bones;
    const Index root = main_root(bones, weights, shared);
    for (Index bone = 0; bone < bones.size(); ++bone)
      if (weights[bone] > 0 && bone != root && !adjoins_above(bone)) waiting_.push_back(bone);
    waited_.assign(bones.size(), false);
    for (const Index bone : waiting_) waited_[bone] = true;
  }

  void run() {
    for (;;) {
      double strongest = 0;
      std::size_t place = 0;
      Index parent = kNone;
      for (std::size_t i = 0; i < waiting_.size(); ++i)
        for (Index other = 0; other < parents_.size(); ++other) {
          const double bond = shared_.of(waiting_[i], other);
          if (!(bond > strongest) || other == waiting_[i] || !is_settled(other)) continue;
          strongest = bond;
          place = i;
          parent = other;
        }
      if (parent == kNone) return;
      const Index bone = waiting_[place];
      parents_[bone] = not_at_joint_of(bone, with_own_parents(bone, parent, strongest));
      waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(place));
    }
  }

 private:
  [[nodiscard]] bool adjoins_above(Index bone) const {
    for (Index above = parents_[bone]; above != kNone; above = parents_[above])
      if (shared_.of(bone, above) > 0) return true;
    return false;
  }
  /// The bone that a bone shares most with of those that never waited, if that is not much less
  /// than the strongest bond; otherwise the one with that bond. Two thighs may share more of a
  /// skirt with each other than each with the hips.
  [[nodiscard]] Index with_own_parents(Index bone, Index strongest, double bond) const {
    double most = kLeastOfStrongest * bond;
    Index parent = strongest;
    for (Index other = 0; other < parents_.size(); ++other)
      if (!waited_[other] && shared_.of(bone, other) > most && is_settled(other)) {
        most = shared_.of(bone, other);
        parent = other;
      }
    return parent;
  }
  /// The bone, or the nearest above it that begins elsewhere: limbs that begin at one joint, such
  /// as neck and back of a fish, do not hang on one another.
  [[nodiscard]] Index not_at_joint_of(Index bone, Index parent) const {
    const double least = kSameJointSizes * surface_.size();
    while (parents_[parent] != kNone &&
           norm(surface_.joint(bone) - surface_.joint(parent)) <= least)
      parent = parents_[parent];
    return parent;
  }
  /// Whether neither a bone nor one above it waits for a parent.
  [[nodiscard]] bool is_settled(Index bone) const {
    for (; bone != kNone; bone = parents_[bone])
      if (std::find(waiting_.begin(), waiting_.end(), bone) != waiting_.end()) return false;
    return true;
  }

  const PosedSurface& surface_;
  const SharedSurface& shared_;
  std::vector<Index>& parents_;
  std::vector<Index> waiting_;
  std::vector<bool> waited_;  ///< One per bone.
};

/// Bones that hold one rigid part of what the bone above them is: the cubes of a head. They share
/// no place of the surface with other bones, no bone hangs on them, and no clip moves them.
std::vector<bool> rigid_parts(const PosedSurface& surface, const std::vector<double>& weights) {
  const Character& character = surface.character();
  const std::vector<Bone>& bones = character.skeleton.bones;
  std::vector<bool> is_part;
  for (const double weight : weights) is_part.push_back(weight > 0);
  for (Index point = 0; point < surface.surface().point_count(); ++point)
    for_each_influence(surface, point, [&](Index bone, double weight) {
      if (weight < 1) is_part[bone] = false;
    });
  for (const Bone& bone : bones)
    if (bone.parent != kNone) is_part[bone.parent] = false;
  for (const Clip& clip : character.clips)
    for (const Channel& channel : clip.channels)
      if (channel.target != ChannelTarget::morph_weights) is_part[channel.index] = false;
  return is_part;
}

}  // namespace

BoneTree::BoneTree(const PosedSurface& surface) {
  const auto& bones = surface.character().skeleton.bones;
  weights_.assign(bones.size(), 0.0);
  for (Index point = 0; point < surface.surface().point_count(); ++point)
    for_each_influence(surface, point,
                       [&](Index bone, double weight) { weights_[bone] += weight; });
  is_rigid_part_ = rigid_parts(surface, weights_);
  for (const Bone& bone : bones) parents_.push_back(bone.parent);
  const SharedSurface shared(surface);
  shared_ = shared.by_bone(bones.size());
  Adoption(surface, weights_, shared, parents_).run();
  for (Index bone = 0; bone < bones.size(); ++bone)
    is_adopted_.push_back(parents_[bone] != bones[bone].parent);
  children_.resize(bones.size());
  for (Index bone = 0; bone < bones.size(); ++bone)
    if (parents_[bone] != kNone) children_[parents_[bone]].push_back(bone);
}

bool BoneTree::is_below(Index bone, Index top) const {
  for (Index above = parents_[bone]; above != kNone; above = parents_[above])
    if (above == top) return true;
  return false;
}

Index BoneTree::moving_parent(Index bone) const {
  Index above = parents_[bone];
  while (above != kNone && !moves(above)) above = parents_[above];
  return above;
}

bool BoneTree::is_made_of_parts(const Skeleton& skeleton, Index bone) const {
  if (moves(bone)) return false;
  for (Index i = 0; i < skeleton.bones.size(); ++i)
    if (skeleton.bones[i].parent == bone && is_rigid_part_[i] &&
        skeleton.bones[i].rest != BoneTransform{})
      return true;
  return false;
}

std::vector<Index> BoneTree::same_bones(const Skeleton& skeleton, Index bone) const {
  std::vector<Index> same = {bone};
  for (Index i = 0; i < skeleton.bones.size(); ++i) {
    const bool is_part = skeleton.bones[i].parent == skeleton.bones[bone].parent &&
                         skeleton.bones[i].parent != kNone &&
                         skeleton.bones[i].rest == skeleton.bones[bone].rest;
    const bool is_stand_in = !moves(bone) && skeleton.bones[i].parent == bone &&
                             (is_rigid_part_[i] || skeleton.bones[i].rest == BoneTransform{});
    if (i != bone && (is_part || is_stand_in)) same.push_back(i);
  }
  return same;
}

}  // namespace sunder::aim
