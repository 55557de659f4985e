// Contract of sunder/animation/blend.h.

#include <sunder/animation/blend.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/machine/random.h"
#include "support/models/rigs.h"

namespace sunder::test {
namespace {

Pose some_pose(Random& random, std::size_t bones = 6, std::size_t morphs = 2, double angle = 1.0) {
  Pose pose;
  const auto number = [&] { return static_cast<float>(random.uniform(-2, 2)); };
  for (std::size_t i = 0; i < bones; ++i) {
    BoneTransform bone;
    bone.translation = {number(), number(), number()};
    bone.rotation = Quatf(Eigen::AngleAxisf(static_cast<float>(random.uniform(-angle, angle)),
                                            Eigen::Vector3f(random.direction().cast<float>())));
    bone.scale = {1 + 0.2f * number(), 1 + 0.2f * number(), -1 + 0.2f * number()};
    pose.parent_from_bone.push_back(bone);
  }
  for (std::size_t i = 0; i < morphs; ++i) pose.morph_weights.push_back(number());
  return pose;
}

/// The largest difference of any number; quaternions and their negatives are the same.
double distance(const Pose& a, const Pose& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.parent_from_bone.size(); ++i) {
    const BoneTransform &one = a.parent_from_bone[i], &other = b.parent_from_bone[i];
    const float sign = one.rotation.dot(other.rotation) < 0 ? -1.0f : 1.0f;
    most = std::max(
        {most, static_cast<double>((one.translation - other.translation).norm()),
         static_cast<double>((one.scale - other.scale).norm()),
         static_cast<double>((one.rotation.coeffs() - sign * other.rotation.coeffs()).norm())});
  }
  for (std::size_t i = 0; i < a.morph_weights.size(); ++i)
    most = std::max(most, static_cast<double>(std::abs(a.morph_weights[i] - b.morph_weights[i])));
  return most;
}

TEST(Blend, of_one_pose_and_of_equal_poses_is_that_pose) {
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const Pose pose = some_pose(random);
    Pose result;
    const Pose* const poses[] = {&pose, &pose, &pose};
    const float weights[] = {0.3f, 2.0f, 0.0f};
    ASSERT_TRUE(blend(poses, weights, result));
    EXPECT_LT(distance(result, pose), 1e-6);
  }
}

TEST(Blend, is_near_slerp_and_ignores_signs_of_quaternions) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    Pose a = some_pose(random), b = some_pose(random);
    for (std::size_t bone = 0; bone < a.parent_from_bone.size(); ++bone)
      b.parent_from_bone[bone].rotation =
          a.parent_from_bone[bone].rotation *
          Quatf(Eigen::AngleAxisf(static_cast<float>(M_PI / 2),
                                  Eigen::Vector3f(random.direction().cast<float>())));
    const float t = static_cast<float>(random.uniform(0, 1));
    Pose result, flipped_result;
    const Pose* const poses[] = {&a, &b};
    const float weights[] = {1 - t, t};
    ASSERT_TRUE(blend(poses, weights, result));
    for (std::size_t bone = 0; bone < a.parent_from_bone.size(); ++bone) {
      const Quatf expected =
          a.parent_from_bone[bone].rotation.slerp(t, b.parent_from_bone[bone].rotation);
      EXPECT_LT(result.parent_from_bone[bone].rotation.angularDistance(expected),
                0.93f * static_cast<float>(M_PI) / 180);
      EXPECT_NEAR(result.parent_from_bone[bone].rotation.norm(), 1.0f, 1e-6f);
    }
    for (BoneTransform& bone : b.parent_from_bone) bone.rotation.coeffs() *= -1.0f;
    ASSERT_TRUE(blend(poses, weights, flipped_result));
    EXPECT_EQ(distance(result, flipped_result), 0.0);
    Pose towards = a;
    ASSERT_TRUE(blend_towards(b, t, towards));
    EXPECT_LT(distance(towards, result), 1e-5);
  }
}

TEST(Blend, of_many_poses_does_not_depend_on_their_order) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Pose a = some_pose(random, 6, 2, 3), b = some_pose(random, 6, 2, 3),
               c = some_pose(random, 6, 2, 3);
    const Pose* const order[] = {&a, &b, &c};
    const Pose* const other_order[] = {&c, &a, &b};
    const float weights[] = {0.2f, 0.5f, 0.3f}, other_weights[] = {0.3f, 0.2f, 0.5f};
    Pose first, second = c;
    ASSERT_TRUE(blend(order, weights, first));
    ASSERT_TRUE(blend(other_order, other_weights, second));
    EXPECT_LT(distance(first, second), 1e-5);
  }
}

TEST(Blend, the_result_may_be_one_of_the_poses) {
  Random random(4);
  Pose a = some_pose(random);
  const Pose b = some_pose(random);
  const Pose* const poses[] = {&a, &b};
  const float weights[] = {1.0f, 1.0f};
  Pose apart;
  ASSERT_TRUE(blend(poses, weights, apart));
  ASSERT_TRUE(blend(poses, weights, a));
  EXPECT_EQ(a.parent_from_bone, apart.parent_from_bone);
  EXPECT_EQ(a.morph_weights, apart.morph_weights);
}

TEST(Blend, ends_keep_their_bits) {
  Random random(5);
  const Pose a = some_pose(random), b = some_pose(random);
  Pose pose = a;
  ASSERT_TRUE(blend_towards(b, 0.0f, pose));
  EXPECT_EQ(pose.parent_from_bone, a.parent_from_bone);
  ASSERT_TRUE(blend_towards(b, 1.0f, pose));
  EXPECT_EQ(pose.parent_from_bone, b.parent_from_bone);
  EXPECT_EQ(pose.morph_weights, b.morph_weights);
}

TEST(Blend, additive_layers_give_the_pose_back) {
  Random random(6);
  for (int i = 0; i < 50; ++i) {
    const Pose pose = some_pose(random), reference = some_pose(random), other = some_pose(random);
    PoseDelta delta;
    ASSERT_TRUE(make_additive(pose, reference, delta));
    Pose sum = reference;
    ASSERT_TRUE(add(delta, 1.0f, sum));
    EXPECT_LT(distance(sum, pose), 5e-6);
    Pose none = other;
    ASSERT_TRUE(add(delta, 0.0f, none));
    EXPECT_EQ(none.parent_from_bone, other.parent_from_bone);
    ASSERT_TRUE(make_additive(pose, pose, delta));
    ASSERT_TRUE(add(delta, 0.7f, none));
    EXPECT_LT(distance(none, other), 1e-5);
  }
  Pose zero = some_pose(random), pose = some_pose(random);
  zero.parent_from_bone[2].scale.setZero();
  PoseDelta delta;
  ASSERT_TRUE(make_additive(pose, zero, delta));
  ASSERT_TRUE(add(delta, 1.0f, pose));
  for (const BoneTransform& bone : pose.parent_from_bone) EXPECT_TRUE(bone.scale.allFinite());
}

TEST(Blend, masks_of_subtrees) {
  const Character tubes = make_two_tubes(4, 6);
  const auto mask = subtree_mask(tubes.skeleton, 1, 1.0f, 0.25f);
  ASSERT_TRUE(mask);
  for (std::uint32_t bone = 0; bone < tubes.skeleton.bones.size(); ++bone) {
    bool is_inside = false;
    for (std::uint32_t at = bone; at != kNone; at = tubes.skeleton.bones[at].parent)
      is_inside |= at == 1;
    EXPECT_EQ(mask->bones[bone], is_inside ? 1.0f : 0.25f);
  }
  Random random(7);
  const std::size_t count = tubes.skeleton.bones.size();
  const Pose a = some_pose(random, count), b = some_pose(random, count);
  const BoneMask half = *subtree_mask(tubes.skeleton, 1);
  Pose pose = a;
  ASSERT_TRUE(blend_towards(b, 1.0f, pose, &half));
  for (std::uint32_t bone = 0; bone < count; ++bone)
    EXPECT_EQ(pose.parent_from_bone[bone],
              (half.bones[bone] == 1.0f ? b : a).parent_from_bone[bone]);
  EXPECT_EQ(pose.morph_weights, a.morph_weights);
}

TEST(Blend, allocates_nothing_when_warm) {
  Random random(8);
  const Pose a = some_pose(random), b = some_pose(random);
  Pose result = a;
  PoseDelta delta;
  ASSERT_TRUE(make_additive(a, b, delta));
  const Pose* const poses[] = {&a, &b};
  const float weights[] = {1, 2};
  const std::uint64_t before = allocation_count();
  ASSERT_TRUE(blend(poses, weights, result));
  ASSERT_TRUE(blend_towards(b, 0.5f, result));
  ASSERT_TRUE(make_additive(a, b, delta));
  ASSERT_TRUE(add(delta, 0.5f, result));
  EXPECT_EQ(allocation_count(), before);
}

TEST(Blend, refuses_bad_arguments_and_writes_nothing) {
  Random random(9);
  const Pose a = some_pose(random), small = some_pose(random, 3);
  Pose result = a;
  const Pose* const poses[] = {&a, &small};
  const Pose* const missing[] = {&a, nullptr};
  const Pose* const same[] = {&a, &a};
  const float weights[] = {1, 1}, zero[] = {0, 0}, negative[] = {1, -1},
              infinite[] = {1, std::numeric_limits<float>::infinity()}, one[] = {1};
  EXPECT_EQ(blend({}, {}, result).code(), StatusCode::empty_input);
  EXPECT_EQ(blend(poses, weights, result).code(), StatusCode::size_mismatch);
  EXPECT_EQ(blend(same, one, result).code(), StatusCode::size_mismatch);
  EXPECT_EQ(blend(missing, weights, result).code(), StatusCode::invalid_argument);
  EXPECT_EQ(blend(same, zero, result).code(), StatusCode::invalid_argument);
  EXPECT_EQ(blend(same, negative, result).code(), StatusCode::invalid_argument);
  EXPECT_EQ(blend(same, infinite, result).code(), StatusCode::invalid_argument);
  EXPECT_EQ(blend_towards(small, 0.5f, result).code(), StatusCode::size_mismatch);
  EXPECT_EQ(blend_towards(a, 1.5f, result).code(), StatusCode::invalid_argument);
  EXPECT_EQ(blend_towards(a, NAN, result).code(), StatusCode::invalid_argument);
  BoneMask mask;
  EXPECT_EQ(blend_towards(a, 0.5f, result, &mask).code(), StatusCode::size_mismatch);
  mask.bones.assign(6, 2.0f);
  EXPECT_EQ(blend_towards(a, 0.5f, result, &mask).code(), StatusCode::invalid_argument);
  PoseDelta delta;
  EXPECT_EQ(make_additive(a, small, delta).code(), StatusCode::size_mismatch);
  EXPECT_EQ(add(delta, 1.0f, result).code(), StatusCode::size_mismatch);
  EXPECT_EQ(subtree_mask(Skeleton(), 0).error().code(), StatusCode::index_out_of_range);
  EXPECT_EQ(result.parent_from_bone, a.parent_from_bone);
}

}  // namespace
}  // namespace sunder::test
