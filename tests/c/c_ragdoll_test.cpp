// Ragdolls through C: the same bodies as in C++, poses and places there and back.

#include <sunder/ragdoll/ragdoll.h>
#include <sunder/skinning/pose.h>

#include <algorithm>

#include "c/c_objects.h"
#include "support/machine/random.h"
#include "support/models/rigs.h"

namespace sunder::test {
namespace {

struct CRagdoll : testing::Test {
  Character tube = make_tube(16, 12, 5);
  ModelPose pose;
  sunder_character character = create(tube);
  sunder_ragdoll ragdoll = 0;
  const sunder_ragdoll_body* bodies = nullptr;
  std::uint32_t count = 0;

  void SetUp() override {
    Random random(4);
    pose = random_pose(tube, random, 0.4, 1.0);
    EXPECT_DONE(
        sunder_create_ragdoll(character, numbers(), bone_count(), nullptr, nullptr, &ragdoll));
    EXPECT_DONE(sunder_get_ragdoll_bodies(ragdoll, &bodies, &count));
  }
  void TearDown() override {
    EXPECT_DONE(sunder_destroy_ragdoll(ragdoll));
    EXPECT_DONE(sunder_destroy_character(character));
  }
  [[nodiscard]] const double* numbers() const { return pose.model_from_bone.front().data(); }
  [[nodiscard]] std::uint32_t bone_count() const {
    return static_cast<std::uint32_t>(pose.model_from_bone.size());
  }
};

TEST_F(CRagdoll, has_the_bodies_of_cpp) {
  pose.morph_weights = tube.rest_morph_weights;
  const auto expected = make_ragdoll(tube, pose);
  ASSERT_TRUE(expected);
  ASSERT_EQ(count, expected->bodies.size());
  ASSERT_GT(count, 2u);
  for (std::uint32_t i = 0; i < count; ++i) {
    const RagdollBody& body = expected->bodies[i];
    EXPECT_EQ(bodies[i].bone, body.bone);
    EXPECT_EQ(bodies[i].parent, body.parent);
    EXPECT_EQ(bodies[i].mass, body.mass);
    EXPECT_TRUE(std::equal(body.moments.data(), body.moments.data() + 3, bodies[i].moments));
    const auto same = [](const Affine3d& frame, const double* found) {
      return std::equal(frame.data(), frame.data() + 12, found);
    };
    EXPECT_TRUE(same(body.model_from_body, bodies[i].model_from_body));
    EXPECT_TRUE(same(body.parent_from_joint, bodies[i].parent_from_joint));
    EXPECT_TRUE(same(body.body_from_joint, bodies[i].body_from_joint));
    EXPECT_EQ(bodies[i].limit.kind, static_cast<std::uint32_t>(body.limit.kind));
    EXPECT_EQ(bodies[i].limit.cone, body.limit.cone);
    EXPECT_EQ(bodies[i].shape.shape, std::size_t{body.shape.shape.index()});
    EXPECT_TRUE(
        std::equal(body.shape.place.data(), body.shape.place.data() + 3, bodies[i].shape.place));
  }
}

TEST_F(CRagdoll, poses_give_places_and_places_poses) {
  std::vector<double> places(12 * count), back(12 * bone_count()), turns(4 * count);
  EXPECT_DONE(sunder_place_bodies(ragdoll, numbers(), bone_count(), places.data()));
  for (std::uint32_t i = 0; i < 12 * count; ++i)
    EXPECT_NEAR(places[i], bodies[i / 12].model_from_body[i % 12], 1e-6);
  EXPECT_DONE(sunder_pose_of_bodies(ragdoll, places.data(), count, back.data()));
  for (std::uint32_t i = 0; i < 12 * bone_count(); ++i) EXPECT_NEAR(back[i], numbers()[i], 1e-6);
  EXPECT_DONE(sunder_get_joint_turns(ragdoll, places.data(), count, turns.data()));
  for (std::uint32_t i = 0; i < count; ++i)
    EXPECT_NEAR(std::hypot(std::hypot(turns[4 * i], turns[4 * i + 1]),
                           std::hypot(turns[4 * i + 2], turns[4 * i + 3])),
                1.0, 1e-9);
}

TEST_F(CRagdoll, hulls_lie_around_the_bodies) {
  const sunder_hull* hulls = nullptr;
  std::uint32_t hull_count = 0;
  const sunder_status status = sunder_get_ragdoll_hulls(ragdoll, 64, &hulls, &hull_count);
  if ((sunder_features() & SUNDER_FEATURE_HULLS) == 0) {
    EXPECT_EQ(status, SUNDER_UNSUPPORTED_FEATURE);
    return;
  }
  EXPECT_DONE(status);
  ASSERT_EQ(hull_count, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    EXPECT_GT(hulls[i].volume, 0);
    EXPECT_EQ(hulls[i].bone, bodies[i].bone);
  }
}

TEST_F(CRagdoll, faults_are_named_and_nothing_is_written) {
  sunder_ragdoll other = 77;
  sunder_ragdoll_options options = sunder_default_ragdoll_options();
  const auto create_with = [&] {
    return sunder_create_ragdoll(character, numbers(), bone_count(), nullptr, &options, &other);
  };
  EXPECT_EQ(sunder_create_ragdoll(character, numbers(), 2, nullptr, nullptr, &other),
            SUNDER_SIZE_MISMATCH);
  options.struct_size = 3;
  EXPECT_EQ(create_with(), SUNDER_INVALID_STRUCT);
  options = sunder_default_ragdoll_options();
  options.maximum_bodies = 0;
  EXPECT_EQ(create_with(), SUNDER_INVALID_ARGUMENT);
  options = sunder_default_ragdoll_options();
  options.limit_count = 1;
  EXPECT_EQ(create_with(), SUNDER_NULL_POINTER);
  sunder_bone_limit limit = {99, SUNDER_JOINT_CONE, {1, 0, 0}, 0, 0, 0};
  options.limits = &limit;
  EXPECT_EQ(create_with(), SUNDER_INDEX_OUT_OF_RANGE);
  limit.bone = 1;
  limit.kind = 9;
  EXPECT_EQ(create_with(), SUNDER_INVALID_ARGUMENT);
  EXPECT_EQ(other, 77u);
  std::vector<double> places(12 * count, 5.0);
  EXPECT_EQ(sunder_place_bodies(ragdoll, numbers(), 1, places.data()), SUNDER_SIZE_MISMATCH);
  EXPECT_EQ(places[0], 5.0);
  std::vector<double> turns(4 * count);
  EXPECT_EQ(sunder_get_joint_turns(ragdoll, places.data(), count + 1, turns.data()),
            SUNDER_SIZE_MISMATCH);
  EXPECT_EQ(sunder_destroy_ragdoll(character), SUNDER_INVALID_HANDLE);
}

}  // namespace
}  // namespace sunder::test
