// Compares the rest of particles in a pose with their members skinned one by one.
#include <sunder/particles/particle_set.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <limits>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/particle_laws.h"

namespace sunder {
namespace {

using test::make_model;
using test::Random;
using testing::IsEmpty;

ParticleSet decompose(const TornModel& model, const ModelPose& pose, double range) {
  auto set = ParticleSet::create(model, pose, {range});
  EXPECT_TRUE(set) << set.error().text();
  return std::move(*set);
}

void rest_at_random(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  TornModel model =
      make_model(seed % 3 == 0   ? test::make_two_tubes(4 + random.index(6), 5 + random.index(6))
                 : seed % 3 == 1 ? test::make_tube(4 + random.index(10), 5 + random.index(8),
                                                   2 + random.index(4))
                                 : test::random_character(random));
  const Character& source = model.source();
  ParticleSet set = decompose(model, test::random_pose(source, random), random.uniform(0.08, 0.3));
  const auto expect_rest = [&] {
    for (int i = 0; i < 3; ++i)
      ASSERT_THAT(test::broken_rest(model, set, test::random_pose(source, random, 1.5, 1.6)),
                  IsEmpty());
    ASSERT_THAT(test::broken_rest(model, set, *bind_pose(source)), IsEmpty());
  };
  const auto follow = [&](const ChangeRecord& change) {
    ASSERT_TRUE(set.follow(model, {&change, 1}));
    while (set.settle(model, 1 + random.index(200))) ASSERT_NO_FATAL_FAILURE(expect_rest());
    ASSERT_NO_FATAL_FAILURE(expect_rest());
  };
  ASSERT_NO_FATAL_FAILURE(expect_rest());
  constexpr std::array kPolicies = {WeightPolicy::barycentric, WeightPolicy::pose_exact,
                                    WeightPolicy::exact};
  for (int i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    WeightOptions options;
    options.policy = kPolicies[random.index(3)];
    ASSERT_TRUE(model.set_weights(options));
    ChangeRecord change;
    const std::uint32_t before = model.undo_count();
    ASSERT_TRUE(test::play(model, test::random_operation(model, random), &change));
    if (model.undo_count() > before) {
      ASSERT_NO_FATAL_FAILURE(follow(change));
    }
    if (random.index(3) == 0 && model.undo_count() > 0) {
      ASSERT_TRUE(model.undo(&change));
      ASSERT_NO_FATAL_FAILURE(follow(change));
    }
    if (random.index(2) == 0 && model.undo_count() > 0) {
      WeightsOperation wanted;
      wanted.weights.policy = kPolicies[random.index(3)];
      wanted.pose = test::random_pose(source, random);
      const auto report = model.reweigh(wanted, &change);
      if (report) {
        ASSERT_NO_FATAL_FAILURE(follow(change));
      }
    }
  }
  while (model.undo_count() > 0) {
    ChangeRecord change;
    ASSERT_TRUE(model.undo(&change));
    ASSERT_NO_FATAL_FAILURE(follow(change));
  }
}

class RandomRest : public testing::TestWithParam<int> {};

TEST_P(RandomRest, is_the_centroid_of_the_members_in_every_pose) {
  const int rounds = test::stressed(1, 50);
  for (int round = 0; round < rounds && !HasFailure(); ++round)
    rest_at_random(static_cast<std::uint64_t>(100 * round + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(seeds, RandomRest, testing::Range(0, 40));

/// A tear and a refit, followed one by one or both at once. Former weights are known only one by
/// one, and not those of the policy `exact`; without them particles are summed up again.
void follow_a_refit(WeightPolicy policy, bool at_once) {
  TornModel model = make_model(test::make_tube(8, 8, 3));
  const ModelPose pose = *bind_pose(model.source());
  ParticleSet set = decompose(model, pose, 0.15);
  Random random(4);
  WeightOptions options;
  options.policy = policy;
  ASSERT_TRUE(model.set_weights(options));
  std::vector<ChangeRecord> changes(2);
  ASSERT_TRUE(
      model.tear(pose, test::random_stroke(model.source(), pose, random, 0.3), {}, &changes[0]));
  if (!at_once) {
    ASSERT_TRUE(set.follow(model, {&changes[0], 1}));
  }
  WeightsOperation wanted;
  wanted.weights.policy = WeightPolicy::refit;
  const auto report = model.reweigh(wanted, &changes[1]);
  ASSERT_TRUE(report) << report.error().text();
  ASSERT_TRUE(set.follow(model, at_once ? std::span(changes) : std::span(changes).subspan(1)));
  while (set.settle(model)) {
  }
  for (int i = 0; i < 5; ++i)
    EXPECT_THAT(test::broken_rest(model, set, test::random_pose(model.source(), random)),
                IsEmpty());
}

TEST(Rest, is_the_same_after_a_refit) {
  for (const WeightPolicy policy : {WeightPolicy::barycentric, WeightPolicy::exact})
    for (const bool at_once : {false, true}) {
      SCOPED_TRACE(static_cast<int>(policy));
      SCOPED_TRACE(at_once);
      follow_a_refit(policy, at_once);
    }
}

TEST(Rest, goes_along_with_a_rigid_motion) {
  TornModel model = make_model(test::make_tube(8, 8, 3));
  const ModelPose bind = *bind_pose(model.source());
  const ParticleSet set = decompose(model, bind, 0.2);
  Affine3d motion = Affine3d::Identity();
  motion.translate(Vec3d(1, 2, 3)).rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(0, 0.6, 0.8)));
  ModelPose moved = bind;
  for (Affine3d& bone : moved.model_from_bone) bone = motion * bone;
  std::vector<std::uint32_t> all(set.particle_count());
  std::iota(all.rbegin(), all.rend(), 0u);  // in any order
  std::vector<ParticleRest> before(all.size()), after(all.size());
  ASSERT_TRUE(set.rest(bind, all, before));
  ASSERT_TRUE(set.rest(moved, all, after));
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_LT((before[i].linear - Mat3d::Identity()).norm(), 1e-6);
    EXPECT_LT((after[i].place - motion * before[i].place).norm(), 1e-6);
    EXPECT_LT((after[i].linear - motion.linear()).norm(), 1e-6);
  }
  const std::uint64_t count = test::allocation_count();
  const Status status = set.rest(moved, all, after);
  EXPECT_EQ(test::allocation_count(), count) << "warm";
  ASSERT_TRUE(status);
}

TEST(Rest, refuses_poses_that_do_not_fit) {
  const TornModel model = make_model(test::make_tube(5, 6, 3));
  const ParticleSet set = decompose(model, *bind_pose(model.source()), 0.2);
  const std::vector<std::uint32_t> particles = {0, 1};
  const auto expect_refused = [&](const ModelPose& pose, std::size_t room, StatusCode code) {
    std::vector<ParticleRest> rest(room);
    rest[0].place = {7, 7, 7};
    const Status status = set.rest(pose, particles, rest);
    EXPECT_EQ(status.code(), code) << status.text();
    EXPECT_FALSE(status.text().empty());
    EXPECT_EQ(rest[0].place, Vec3d(7, 7, 7));
  };
  ModelPose pose = *bind_pose(model.source());
  expect_refused(pose, 1, StatusCode::size_mismatch);
  pose.model_from_bone.pop_back();
  expect_refused(pose, 2, StatusCode::size_mismatch);
  pose = *bind_pose(model.source());
  pose.morph_weights.clear();
  expect_refused(pose, 2, StatusCode::size_mismatch);
  pose = *bind_pose(model.source());
  pose.model_from_bone[2](1, 3) = std::numeric_limits<double>::infinity();
  expect_refused(pose, 2, StatusCode::non_finite_value);
  pose = *bind_pose(model.source());
  pose.morph_weights[0] = std::numeric_limits<float>::quiet_NaN();
  expect_refused(pose, 2, StatusCode::non_finite_value);
}

}  // namespace
}  // namespace sunder
