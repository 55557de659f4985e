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
      : skeleton_(skeleton),
        masses_(std::move(masses)),
        joined_(masses_.size(), kNone),
        up_(masses_.size()) {
    for (std::uint32_t bone = 0; bone < up_.size(); ++bone)
      up_[bone] = skeleton_.bones[bone].parent;
    find_below();
  }

  void join_lighter_than(double least) {
    for (bool changes = true; changes; find_below()) {
      changes = false;
      for (auto bone = static_cast<std::uint32_t>(masses_.size()); bone-- > 0;)
        if (has_body(bone) && masses_[bone] < least) changes |= join(bone);
    }
  }
  /// The lightest bodies beyond the most join others.
  void join_beyond(std::uint32_t most) {
    std::vector<std::uint32_t> bodies;
    for (std::uint32_t bone = 0; bone < masses_.size(); ++bone)
      if (has_body(bone)) bodies.push_back(bone);
    if (bodies.size() <= most) return;
    std::ranges::stable_sort(bodies, {}, [&](std::uint32_t bone) { return masses_[bone]; });
    const std::uint32_t heaviest = bodies.back();
    bodies.resize(bodies.size() - most);
    std::ranges::sort(bodies, std::greater<>());  // those below before those above
    for (const std::uint32_t bone : bodies)
      if (!join(bone)) join_to(bone, heaviest);
    find_below();
  }
  [[nodiscard]] double mass(std::uint32_t bone) const { return masses_[bone]; }
  [[nodiscard]] bool has_body(std::uint32_t bone) const { return masses_[bone] > 0; }
  [[nodiscard]] bool is_joined(std::uint32_t bone) const { return joined_[bone] != kNone; }
  /// The bone with the body that this one is, or goes with; kNone if there is none below it.
  [[nodiscard]] std::uint32_t mover_of(std::uint32_t bone) {
    return has_body(bone) || is_joined(bone) ? now_of(bone) : below_[bone];
  }

 private:
  /// From the leaves up: the heaviest of the nearest bodies below each bone.
  void find_below() {
    below_.assign(masses_.size(), kNone);
    for (auto bone = static_cast<std::uint32_t>(masses_.size()); bone-- > 0;) {
      const std::uint32_t parent = skeleton_.bones[bone].parent;
      const std::uint32_t nearest = has_body(bone) ? bone : below_[bone];
      if (parent == kNone || nearest == kNone) continue;
      std::uint32_t& best = below_[parent];
      if (best == kNone || masses_[nearest] >= masses_[best]) best = nearest;
    }
  }
  [[nodiscard]] std::uint32_t now_of(std::uint32_t bone) {
    std::uint32_t now = bone;
    while (joined_[now] != kNone) now = joined_[now];
    while (bone != now) bone = std::exchange(joined_[bone], now);  // shorter for later searches
    return now;
  }
  [[nodiscard]] std::uint32_t body_above(std::uint32_t bone) {
    std::uint32_t above = up_[bone];
    while (above != kNone && !has_body(above)) above = up_[above];
    while (up_[bone] != above) bone = std::exchange(up_[bone], above);
    return above;
  }
  /// @return whether there is another body above, or below.
  bool join(std::uint32_t bone) {
    std::uint32_t to = body_above(bone);
    if (to == kNone && below_[bone] != kNone) to = now_of(below_[bone]);
    if (to == kNone || to == bone) return false;
    join_to(bone, to);
    return true;
  }
  void join_to(std::uint32_t bone, std::uint32_t to) {
    masses_[to] += masses_[bone];
    masses_[bone] = 0;
    joined_[bone] = to;
  }

  const Skeleton& skeleton_;
  std::vector<double> masses_;         ///< Per bone; 0 without a body.
  std::vector<std::uint32_t> joined_;  ///< Of a bone whose body joined another one: that bone.
  std::vector<std::uint32_t> up_;      ///< A bone above; none between has a body.
  std::vector<std::uint32_t> below_;
};

bool hangs_on(const BodyTree& tree, std::uint32_t body, std::uint32_t above) {
  while (body != kNone && body != above) body = tree.parents[body];
  return body == above;
}

/// Ties each body to the first on the way up that does not hang on it.
void tie_to_bones_above(const Skeleton& skeleton, Joining& joining,
                        const std::vector<std::uint32_t>& body_at, BodyTree& tree) {
  for (std::uint32_t body = 0; body < tree.bones.size(); ++body)
    for (std::uint32_t up = skeleton.bones[tree.bones[body]].parent;
         up != kNone && tree.parents[body] == kNone; up = skeleton.bones[up].parent) {
      const std::uint32_t mover = joining.mover_of(up);
      if (mover == kNone || hangs_on(tree, body_at[mover], body)) continue;
      tree.parents[body] = body_at[mover];
    }
}

/// Ties the bodies of one tree of bones that hang on none to the heaviest of them.
void tie_roots(const Skeleton& skeleton, const Joining& joining, BodyTree& tree) {
  std::vector<std::uint32_t> root_of(skeleton.bones.size()), main(skeleton.bones.size(), kNone);
  for (std::uint32_t bone = 0; bone < root_of.size(); ++bone) {
    const std::uint32_t parent = skeleton.bones[bone].parent;
    root_of[bone] = parent == kNone ? bone : root_of[parent];
  }
  for (const bool ties : {false, true})
    for (std::uint32_t body = 0; body < tree.bones.size(); ++body) {
      if (tree.parents[body] != kNone) continue;
      std::uint32_t& best = main[root_of[tree.bones[body]]];
      if (!ties &&
          (best == kNone || joining.mass(tree.bones[body]) > joining.mass(tree.bones[best])))
        best = body;
      if (ties && best != body) tree.parents[body] = best;
    }
}

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
  tree.parents.assign(tree.bones.size(), kNone);
  tie_to_bones_above(skeleton, joining, body_at, tree);
  tie_roots(skeleton, joining, tree);
  for (std::uint32_t bone = 0; bone < bone_count; ++bone) {
    const std::uint32_t mover = joining.mover_of(bone), parent = skeleton.bones[bone].parent;
    tree.body_of_bone.push_back(mover != kNone    ? body_at[mover]
                                : parent != kNone ? tree.body_of_bone[parent]
                                                  : 0);
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
