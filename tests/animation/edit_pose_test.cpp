// Contract of sunder/animation/edit_pose.h.

#include <sunder/animation/edit_pose.h>
#include <sunder/skinning/pose.h>

#include <cmath>

#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder::test {
namespace {

Quatd random_rotation(Random& random) {
  return Quatd(Eigen::AngleAxisd(random.uniform(-3, 3), Eigen::Vector3d(random.direction())));
}

/// A chain of five bones: mirrored and evenly scaled, or as it comes.
Skeleton some_skeleton(Random& random, bool is_even) {
  Skeleton skeleton;
  for (std::uint32_t i = 0; i < 5; ++i) {
    Bone bone;
    bone.name = std::to_string(i);
    bone.parent = i == 0 ? kNone : i - 1;
    bone.rest.translation = random.direction().cast<float>();
    bone.rest.rotation = Quatf(random_rotation(random).cast<float>());
    bone.rest.scale.setConstant(static_cast<float>(random.uniform(0.5, 2)));
    if (random.index(2) == 0) bone.rest.scale.z() *= -1;
    if (!is_even) bone.rest.scale.x() *= 1.7f;
    skeleton.bones.push_back(bone);
  }
  return skeleton;
}

Pose rest_of(const Skeleton& skeleton) {
  Pose pose;
  for (const Bone& bone : skeleton.bones) pose.parent_from_bone.push_back(bone.rest);
  return pose;
}

Affine3d model_of(const Skeleton& skeleton, const Pose& pose, std::uint32_t bone) {
  ModelPose model;
  EXPECT_TRUE(compute_model_pose(skeleton, pose, model));
  const auto found = model_from_bone(skeleton, pose, bone);
  EXPECT_TRUE(found);
  EXPECT_LT((found->matrix() - model.model_from_bone[bone].matrix()).norm(), 1e-12);
  return model.model_from_bone[bone];
}

TEST(EditPose, turns_about_the_origin_of_the_bone) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const Skeleton skeleton = some_skeleton(random, true);
    const Pose before = rest_of(skeleton);
    const Quatd turn = random_rotation(random);
    const std::uint32_t bone = random.index(5);
    const Affine3d was = model_of(skeleton, before, bone);
    Pose pose = before;
    ASSERT_TRUE(rotate_bone(skeleton, bone, Quatd(2.5 * turn.coeffs()), EditSpace::model, pose));
    const Affine3d is = model_of(skeleton, pose, bone);
    EXPECT_LT((is.linear() - turn.toRotationMatrix() * was.linear()).norm(), 1e-4) << seed;
    EXPECT_LT((is.translation() - was.translation()).norm(), 1e-9);
    pose = before;
    ASSERT_TRUE(rotate_bone(skeleton, bone, turn, EditSpace::parent, pose));
    const Quatd local = before.parent_from_bone[bone].rotation.cast<double>();
    EXPECT_LT(
        pose.parent_from_bone[bone].rotation.angularDistance(Quatf((turn * local).cast<float>())),
        2e-3f);
    pose = before;
    ASSERT_TRUE(rotate_bone(skeleton, bone, turn, EditSpace::bone, pose));
    EXPECT_LT(
        pose.parent_from_bone[bone].rotation.angularDistance(Quatf((local * turn).cast<float>())),
        2e-3f);
  }
}

TEST(EditPose, moves_and_places) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const Skeleton skeleton = some_skeleton(random, false);
    const Pose before = rest_of(skeleton);
    const std::uint32_t bone = random.index(5);
    const Affine3d was = model_of(skeleton, before, bone);
    const Vec3d offset = random.direction();
    Pose pose = before;
    ASSERT_TRUE(move_bone(skeleton, bone, offset, EditSpace::model, pose));
    EXPECT_LT((model_of(skeleton, pose, bone).translation() - was.translation() - offset).norm(),
              1e-4);
    pose = before;
    ASSERT_TRUE(move_bone(skeleton, bone, offset, EditSpace::bone, pose));
    EXPECT_LT((model_of(skeleton, pose, bone).translation() - was * Eigen::Vector3d(offset)).norm(),
              1e-4);
    pose = before;
    ASSERT_TRUE(move_bone(skeleton, bone, offset, EditSpace::parent, pose));
    EXPECT_LT((pose.parent_from_bone[bone].translation - before.parent_from_bone[bone].translation -
               offset.cast<float>())
                  .norm(),
              1e-5);
    pose = before;
    const Quatd rotation = random_rotation(random);
    ASSERT_TRUE(place_bone(skeleton, bone, offset, rotation, pose));
    EXPECT_LT((model_of(skeleton, pose, bone).translation() - offset).norm(), 1e-4);
  }
}

TEST(EditPose, places_the_axes_of_a_bone) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    Skeleton skeleton = some_skeleton(random, true);
    for (Bone& bone : skeleton.bones) bone.rest.scale.setConstant(1.3f);
    Pose pose = rest_of(skeleton);
    const Quatd rotation = random_rotation(random);
    ASSERT_TRUE(place_bone(skeleton, 4, Vec3d(1, 2, 3), rotation, pose));
    const Eigen::Matrix3d axes = model_of(skeleton, pose, 4).linear() / std::pow(1.3f, 5);
    EXPECT_LT((axes - rotation.toRotationMatrix()).norm(), 1e-5);
  }
}

TEST(EditPose, refuses_bad_arguments_and_changes_nothing) {
  Random random(1);
  Skeleton skeleton = some_skeleton(random, true);
  Pose pose = rest_of(skeleton);
  pose.parent_from_bone[1].scale.setZero();
  const Pose before = pose;
  const Quatd none(0, 0, 0, 0), good = Quatd::Identity();
  const Quatd bad(NAN, 0, 0, 1);
  EXPECT_EQ(rotate_bone(skeleton, 9, good, EditSpace::bone, pose).code(),
            StatusCode::index_out_of_range);
  EXPECT_EQ(rotate_bone(skeleton, 0, none, EditSpace::bone, pose).code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(rotate_bone(skeleton, 0, bad, EditSpace::bone, pose).code(),
            StatusCode::non_finite_value);
  EXPECT_EQ(rotate_bone(skeleton, 3, good, EditSpace::model, pose).code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(move_bone(skeleton, 3, Vec3d(1, 0, 0), EditSpace::model, pose).code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(move_bone(skeleton, 3, Vec3d(NAN, 0, 0), EditSpace::bone, pose).code(),
            StatusCode::non_finite_value);
  EXPECT_EQ(place_bone(skeleton, 3, Vec3d(1, 0, 0), good, pose).code(),
            StatusCode::invalid_argument);
  BoneTransform transform;
  transform.scale.x() = NAN;
  EXPECT_EQ(set_bone(skeleton, 3, transform, pose).code(), StatusCode::non_finite_value);
  Pose small;
  EXPECT_EQ(set_bone(skeleton, 3, BoneTransform(), small).code(), StatusCode::size_mismatch);
  EXPECT_EQ(pose.parent_from_bone, before.parent_from_bone);
  transform = BoneTransform();
  transform.rotation.coeffs() *= 3.0f;
  ASSERT_TRUE(set_bone(skeleton, 3, transform, pose));
  EXPECT_EQ(pose.parent_from_bone[3], BoneTransform());
}

}  // namespace
}  // namespace sunder::test
