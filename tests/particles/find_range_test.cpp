#include <sunder/particles/particle_set.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <cmath>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

namespace sunder::test {
namespace {

struct Scene {
  explicit Scene(Character character)
      : source(std::make_shared<const Character>(std::move(character))),
        model(std::move(*TornModel::create(source))),
        pose(*bind_pose(*source)) {}

  std::shared_ptr<const Character> source;
  TornModel model;
  ModelPose pose;
};

TEST(FindRange, makes_about_as_many_particles_as_wanted) {
  const Scene scene(make_bumpy_ball(3000));
  for (const std::uint32_t wanted : {10u, 40u, 110u, 400u, 1500u}) {
    SCOPED_TRACE(wanted);
    const auto found = find_range_for_particles(scene.model, scene.pose, wanted);
    ASSERT_TRUE(found) << found.error().text();
    EXPECT_NEAR(found->particles, wanted, std::max(1.0, 0.02 * wanted));
    DecompositionOptions options;
    options.range = found->range;
    EXPECT_EQ(ParticleSet::create(scene.model, scene.pose, options)->particle_count(),
              found->particles);
  }
}

TEST(FindRange, is_deterministic_for_a_seed) {
  const Scene scene(make_tube(20, 16, 3));
  const auto first = find_range_for_particles(scene.model, scene.pose, 30, 7),
             second = find_range_for_particles(scene.model, scene.pose, 30, 7);
  EXPECT_EQ(first->range, second->range);
  EXPECT_EQ(first->particles, second->particles);
}

TEST(FindRange, keeps_to_a_time) {
  const Scene scene(make_bumpy_ball(1000));
  const auto generous = find_range_for_step(scene.model, scene.pose, 10.0, *find_material("fat"));
  ASSERT_TRUE(generous) << generous.error().text();
  EXPECT_LE(generous->step_seconds, 10.0);
  EXPECT_GT(generous->step_seconds, 0.0);
  EXPECT_GT(generous->particles, 500u);  // as fine as the surface
  EXPECT_EQ(
      find_range_for_step(scene.model, scene.pose, 1e-12, *find_material("fat")).error().code(),
      StatusCode::not_found);
}

TEST(FindRange, refuses_impossible_requests) {
  const Scene scene(make_sheet(4));
  EXPECT_EQ(find_range_for_particles(scene.model, scene.pose, 0).error().code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(find_range_for_particles(scene.model, scene.pose, 26).error().code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(find_range_for_step(scene.model, scene.pose, -1, {}).error().code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(find_range_for_step(scene.model, scene.pose, std::nan(""), {}).error().code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(find_range_for_particles(scene.model, {}, 4).error().code(), StatusCode::size_mismatch);
}

}  // namespace
}  // namespace sunder::test
