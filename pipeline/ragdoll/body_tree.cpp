#include "pipeline/ragdoll/body_tree.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

namespace sunder::ragdoll {
namespace {

/// The bones of a skeleton while the bodies of some join others.
class Joining {
 public:
  Joining(const Skeleton& skeleton, std::vector<double> masses)
      : skeleton_(skeleton), masses_(std::move(masses)), joined_(masses_.size(), kNone) {
    find_movers();
  }

  void join_lighter_than(double least) {
    for (bool changes = true; changes;) {
      changes = false;
      for (auto bone = static_cast<std::uint32_t>(masses_.size()); bone-- > 0;)
        if (masses_[bone] > 0 && masses_[bone] < least) changes |= join(bone);
      if (changes) find_movers();
    }
  }
  void join_beyond(std::uint32_t most) {
    for (auto count = std::ranges::count_if(masses_, weighs); count > most; --count) {
      const std::uint32_t lightest = extreme(std::less<>(), kNone);
      if (!join(lightest)) join_to(lightest, extreme(std::greater<>(), lightest));
      find_movers();
    }
  }
  [[nodiscard]] bool has_body(std::uint32_t bone) const { return masses_[bone] > 0; }
  [[nodiscard]] bool is_joined(std::uint32_t bone) const { return joined_[bone] != kNone; }
  /// The bone whose body moves this one, or kNone.
  [[nodiscard]] std::uint32_t mover_of(std::uint32_t bone) const { return movers_[bone]; }
  /// Of a bone with a body: the bone to whose body it is tied, or kNone.
  [[nodiscard]] std::uint32_t above(std::uint32_t bone) const { return above_[bone]; }

 private:
  static bool weighs(double mass) { return mass > 0; }

  /// From the leaves up, each bone without a part gets the heaviest mover below it; then, from the
  /// roots down, those above.
  void find_movers() {
    const auto count = static_cast<std::uint32_t>(masses_.size());
    movers_.assign(count, kNone);
    above_.assign(count, kNone);
    below_.assign(count, {});
    for (std::uint32_t bone = count; bone-- > 0;) {
      if (has_body(bone) || is_joined(bone)) movers_[bone] = now_of(bone);
      const std::uint32_t parent = skeleton_.bones[bone].parent, mover = movers_[bone];
      if (parent == kNone || mover == kNone || has_body(parent) || is_joined(parent) ||
          is_joined(bone))
        continue;
      std::uint32_t& best = movers_[parent];
      if (best == kNone || masses_[mover] >= masses_[best]) best = mover;
    }
    for (std::uint32_t bone = 0; bone < count; ++bone) {
      const std::uint32_t parent = skeleton_.bones[bone].parent;
      const std::uint32_t above = parent == kNone ? kNone : movers_[parent];
      std::uint32_t& mover = movers_[bone];
      if (mover == kNone) mover = above;
      if (mover == above || mover == kNone || is_joined(bone)) continue;
      above_[mover] = above;
      if (above != kNone) below_[above].push_back(mover);
    }
  }
  [[nodiscard]] std::uint32_t now_of(std::uint32_t bone) const {
    while (joined_[bone] != kNone) bone = joined_[bone];
    return bone;
  }
  /// @return whether there is a body above or below.
  bool join(std::uint32_t bone) {
    std::uint32_t to = above_[bone];
    if (to == kNone)
      for (const std::uint32_t other : below_[bone])
        if (now_of(other) != bone && (to == kNone || masses_[now_of(other)] > masses_[now_of(to)]))
          to = other;
    if (to == kNone) return false;
    join_to(bone, now_of(to));
    return true;
  }
  void join_to(std::uint32_t bone, std::uint32_t to) {
    masses_[to] += masses_[bone];
    masses_[bone] = 0;
    joined_[bone] = to;
  }
  /// The bone with the least or greatest mass, but for one.
  template <class Before>
  [[nodiscard]] std::uint32_t extreme(Before before, std::uint32_t but) const {
    std::uint32_t best = kNone;
    for (std::uint32_t bone = 0; bone < masses_.size(); ++bone)
      if (bone != but && masses_[bone] > 0 &&
          (best == kNone || before(masses_[bone], masses_[best])))
        best = bone;
    return best;
  }

  const Skeleton& skeleton_;
  std::vector<double> masses_;         ///< Per bone; 0 without a body.
  std::vector<std::uint32_t> joined_;  ///< Of a bone whose body joined another one: that bone.
  std::vector<std::uint32_t> movers_, above_;
  std::vector<std::vector<std::uint32_t>> below_;  ///< Of each bone with a body: those tied to it.
};

/// Renumbers the bodies such that parents come first, otherwise in their order.
void sort_parents_first(BodyTree& tree) {
  const auto count = static_cast<std::uint32_t>(tree.bones.size());
  std::vector<std::uint32_t> depths(count, 0);
  for (std::uint32_t body = 0; body < count; ++body)
    for (std::uint32_t at = tree.parents[body]; at != kNone; at = tree.parents[at]) ++depths[body];
  std::vector<std::uint32_t> order(count), place(count);
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t body) { return depths[body]; });
  for (std::uint32_t i = 0; i < count; ++i) place[order[i]] = i;
  BodyTree sorted;
  for (const std::uint32_t body : order) {
    sorted.bones.push_back(tree.bones[body]);
    sorted.joint_bones.push_back(tree.joint_bones[body]);
    const std::uint32_t parent = tree.parents[body];
    sorted.parents.push_back(parent == kNone ? kNone : place[parent]);
  }
  for (const std::uint32_t body : tree.body_of_bone) sorted.body_of_bone.push_back(place[body]);
  tree = std::move(sorted);
}

bool hangs_on(const BodyTree& tree, std::uint32_t body, std::uint32_t above) {
  while (body != kNone && body != above) body = tree.parents[body];
  return body == above;
}

}  // namespace

BodyTree make_body_tree(const Skeleton& skeleton, std::vector<double> masses, std::uint32_t most,
                        double least_share) {
  const double total = std::accumulate(masses.begin(), masses.end(), 0.0);
  const auto bone_count = static_cast<std::uint32_t>(masses.size());
  Joining joining(skeleton, std::move(masses));
  joining.join_lighter_than(least_share * total);
  joining.join_beyond(most);
  BodyTree tree;
  std::vector<std::uint32_t> body_at(bone_count, kNone);
  for (std::uint32_t bone = 0; bone < bone_count; ++bone) {
    if (!joining.has_body(bone)) continue;
    body_at[bone] = static_cast<std::uint32_t>(tree.bones.size());
    tree.bones.push_back(bone);
    std::uint32_t top = bone, up = skeleton.bones[bone].parent;
    for (; up != kNone && joining.mover_of(up) == bone && !joining.is_joined(up);
         up = skeleton.bones[up].parent)
      top = up;
    tree.joint_bones.push_back(top);
  }
  for (const std::uint32_t bone : tree.bones) {
    const std::uint32_t above = joining.above(bone);
    tree.parents.push_back(above == kNone ? kNone : body_at[above]);
  }
  for (std::uint32_t bone = 0; bone < bone_count; ++bone) {
    const std::uint32_t mover = joining.mover_of(bone);
    tree.body_of_bone.push_back(mover == kNone ? 0 : body_at[mover]);
  }
  sort_parents_first(tree);
  return tree;
}

void follow_borders(std::span<const std::uint32_t> borders, BodyTree& tree) {
  const auto count = static_cast<std::uint32_t>(tree.bones.size());
  for (std::uint32_t body = 0; body < count; ++body) {
    const std::uint32_t parent = tree.parents[body];
    const std::uint32_t* const row = borders.data() + std::size_t{body} * count;
    if (parent == kNone || row[parent] > 0) continue;
    std::uint32_t best = parent;
    for (std::uint32_t other = 0; other < count; ++other)
      if (row[other] > row[best] && !hangs_on(tree, other, body)) best = other;
    tree.parents[body] = best;
  }
  sort_parents_first(tree);
}

}  // namespace sunder::ragdoll
