#include "aim/bone_tree.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>

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

 private:
  static std::uint64_t key(Index a, Index b) {
    return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
  }
  std::unordered_map<std::uint64_t, double> shared_;  // lookups only, never iterated
};

/// The bone that most of the model hangs on, of those that move something and hang on none that
/// does.
Index main_root(const std::vector<Bone>& bones, const std::vector<double>& weights) {
  std::vector<double> below = weights;
  for (std::size_t i = bones.size(); i-- > 0;)  // parents come before children
    if (bones[i].parent != kNone) below[bones[i].parent] += below[i];
  Index root = kNone;
  for (Index i = 0; i < bones.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    Index above = bones[i].parent;
    while (above != kNone && !(weights[above] > 0)) above = bones[above].parent;
    if (above == kNone && (root == kNone || below[i] > below[root])) root = i;
  }
  return root;
}

/// A bone that keeps its place in the skeleton goes before the one with the strongest bond if its
/// own is at least so much of that.
constexpr double kLeastOfStrongest = 0.4;

/// Hangs bones whose surface adjoins no bone above them on the bone that they share most with,
/// those with the strongest bond first.
class Adoption {
 public:
  Adoption(const std::vector<Bone>& bones, const std::vector<double>& weights,
           const SharedSurface& shared, std::vector<Index>& parents)
      : shared_(shared), parents_(parents) {
    const Index root = main_root(bones, weights);
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
      parents_[waiting_[place]] = with_own_parents(waiting_[place], parent, strongest);
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
  /// Whether neither a bone nor one above it waits for a parent.
  [[nodiscard]] bool is_settled(Index bone) const {
    for (; bone != kNone; bone = parents_[bone])
      if (std::find(waiting_.begin(), waiting_.end(), bone) != waiting_.end()) return false;
    return true;
  }

  const SharedSurface& shared_;
  std::vector<Index>& parents_;
  std::vector<Index> waiting_;
  std::vector<bool> waited_;  ///< One per bone.
};

}  // namespace

BoneTree::BoneTree(const PosedSurface& surface) {
  const auto& bones = surface.character().skeleton.bones;
  weights_.assign(bones.size(), 0.0);
  for (Index point = 0; point < surface.surface().point_count(); ++point)
    for_each_influence(surface, point,
                       [&](Index bone, double weight) { weights_[bone] += weight; });
  for (const Bone& bone : bones) parents_.push_back(bone.parent);
  Adoption(bones, weights_, SharedSurface(surface), parents_).run();
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

std::vector<Index> BoneTree::same_bones(const Skeleton& skeleton, Index bone) const {
  std::vector<Index> same = {bone};
  for (Index i = 0; i < skeleton.bones.size(); ++i) {
    const bool is_part = skeleton.bones[i].parent == skeleton.bones[bone].parent &&
                         skeleton.bones[i].parent != kNone &&
                         skeleton.bones[i].rest == skeleton.bones[bone].rest;
    const bool is_stand_in = !moves(bone) && skeleton.bones[i].parent == bone &&
                             skeleton.bones[i].rest == BoneTransform{};
    if (i != bone && (is_part || is_stand_in)) same.push_back(i);
  }
  return same;
}

}  // namespace sunder::aim
