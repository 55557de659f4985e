// Which bones of a ragdoll have bodies: pipeline/ragdoll/body_tree.h.

#include "pipeline/ragdoll/body_tree.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder::test {
namespace {

using ragdoll::BodyTree;
using testing::ElementsAre;

Skeleton skeleton_of(const std::vector<std::uint32_t>& parents) {
  Skeleton skeleton;
  for (const std::uint32_t parent : parents) {
    Bone bone;
    bone.parent = parent;
    skeleton.bones.push_back(bone);
  }
  return skeleton;
}

TEST(BodyTree, a_bone_without_a_part_goes_with_the_heaviest_body_below) {
  // A root without a part, with two bones below; the second has a child.
  const Skeleton skeleton = skeleton_of({kNone, 0, 0, 2});
  const BodyTree tree = ragdoll::make_body_tree(skeleton, {0, 1, 5, 2}, 16, 0.0);
  EXPECT_THAT(tree.bones, ElementsAre(2u, 1u, 3u));
  EXPECT_THAT(tree.parents, ElementsAre(kNone, 0u, 0u));
  EXPECT_THAT(tree.joint_bones, ElementsAre(0u, 1u, 3u));
  EXPECT_THAT(tree.body_of_bone, ElementsAre(0u, 1u, 0u, 2u));
}

TEST(BodyTree, light_bodies_join_the_one_above_and_what_hangs_on_them_follows) {
  // A trunk, a light neck, a head.
  const Skeleton skeleton = skeleton_of({kNone, 0, 1});
  const BodyTree tree = ragdoll::make_body_tree(skeleton, {50, 0.1, 5}, 16, 0.01);
  EXPECT_THAT(tree.bones, ElementsAre(0u, 2u));
  EXPECT_THAT(tree.parents, ElementsAre(kNone, 0u));
  EXPECT_THAT(tree.joint_bones, ElementsAre(0u, 2u));
  EXPECT_THAT(tree.body_of_bone, ElementsAre(0u, 0u, 1u));
}

TEST(BodyTree, feet_that_hang_on_the_root_follow_the_border_to_their_legs) {
  // A root with a leg and a foot.
  BodyTree tree = ragdoll::make_body_tree(skeleton_of({kNone, 0, 0}), {9, 3, 1}, 16, 0.0);
  ASSERT_THAT(tree.parents, ElementsAre(kNone, 0u, 0u));
  ragdoll::follow_borders(std::vector<std::uint32_t>{0, 8, 0, 8, 0, 6, 0, 6, 0}, tree);
  EXPECT_THAT(tree.parents, ElementsAre(kNone, 0u, 1u));
}

/// Chains, flat trees, forests, trees.
int kind_of(int seed) { return seed % 4; }

TEST(BodyTree, random_trees_keep_their_laws_and_large_ones_end) {
  for (int seed = 0; seed < 20'000; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::uint32_t count = seed < 19'996 ? 1 + random.index(40) : 30'000;
    std::vector<std::uint32_t> parents = {kNone};
    std::vector<double> masses = {1.0};
    for (std::uint32_t bone = 1; bone < count; ++bone) {
      const bool is_root = random.index(10) == 0;
      const int kind = kind_of(seed);
      const std::uint32_t parent = kind == 0 ? bone - 1 : kind == 1 ? 0 : random.index(bone);
      parents.push_back(is_root && kind == 2 ? kNone : parent);
      masses.push_back(random.index(4) == 0 ? 0.0 : std::pow(10.0, random.uniform(-3, 0)));
    }
    const std::uint32_t most = 1 + random.index(20);
    const double share = random.index(2) == 0 ? 0.0 : random.uniform(0, 0.2);
    const BodyTree tree = ragdoll::make_body_tree(skeleton_of(parents), masses, most, share);
    const std::size_t bodies = tree.bones.size();
    ASSERT_GE(bodies, 1u);
    EXPECT_LE(bodies, most);
    ASSERT_EQ(tree.parents.size(), bodies);
    for (std::uint32_t body = 0; body < bodies; ++body) {
      EXPECT_TRUE(tree.parents[body] == kNone || tree.parents[body] < body);
      EXPECT_EQ(tree.body_of_bone[tree.bones[body]], body);
      EXPECT_GT(masses[tree.bones[body]], 0.0);
    }
    for (const std::uint32_t body : tree.body_of_bone) EXPECT_LT(body, bodies);
    if (kind_of(seed) == 2) continue;
    EXPECT_EQ(std::ranges::count(tree.parents, kNone), 1) << "one tree of bones has one root";
  }
}

}  // namespace
}  // namespace sunder::test
