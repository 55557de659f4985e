// The wound of a planned tear gapes as wide as it was asked for.

#include <sunder/particles/particle_set.h>
#include <sunder/particles/soft_body.h>
#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plan/plan_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

/// A straight cut of 0.3 m along the front of a tube that bends.
struct GapingScene {
  std::shared_ptr<const Character> character =
      std::make_shared<const Character>(test::make_tube(40, 48, 3));
  WoundTarget target;
  PlanTiming timing;
  PlanTool hand;

  explicit GapingScene(double gape) {
    timing.pose = ClipPose{"Bend", 0.2};
    std::vector<Vec3d> near;
    for (int i = 0; i <= 12; ++i) near.emplace_back(0.02, 0.55 + 0.025 * i, 0.3);
    target.places = test::nearest_places(character, *make_pose(*character, timing.pose), near);
    target.depth = {0.02};
    target.gape = gape;
    hand = *free_hand(character, target, timing, 0.1);
  }
};

/// How wide the lips gape under a tension in particles of another range and another seed.
double gape_by_other_particles(const GapingScene& scene, const TearOperation& tear,
                               const SoftMaterial& material, double tension, std::uint64_t seed) {
  auto model = TornModel::create(scene.character);
  const ModelPose pose = *make_pose(*scene.character, scene.timing.pose);
  auto set = ParticleSet::create(*model, pose, {0.04, false, seed});
  auto body = SoftBody::create(*set, pose, {&material, 1});
  std::vector<ChangeRecord> changes;
  EXPECT_TRUE(apply_operation(*model, tear, &changes));
  EXPECT_TRUE(set->follow(*model, changes));
  while (set->settle(*model)) continue;
  EXPECT_TRUE(body->set_tension({tension, {}}));
  for (int i = 0; i < 600 && (i == 0 || body->awake_count() > 0); ++i)
    EXPECT_TRUE(body->step(*model, pose, 1.0 / 30));
  double widest = 0;
  for (const ChangeRecord& change : changes)
    for (const LipPair& lip : change.lips)
      widest = std::max(
          widest,
          (body->point_displacement(lip.left) - body->point_displacement(lip.right)).norm());
  return widest;
}

TEST(PlannedGape, is_that_of_the_settled_copy) {
  for (const double gape : {0.006, 0.02})
    for (const char* const name : {"skin", "rubber"}) {
      const GapingScene scene(gape);
      PlanOptions options;
      options.material = *find_material(name);
      const auto planned =
          plan_motion(scene.character, scene.target, scene.timing, scene.hand, options);
      ASSERT_TRUE(planned) << planned.error().text();
      ASSERT_TRUE(planned->report.is_reachable);
      ASSERT_TRUE(planned->report.gape);
      EXPECT_NEAR(planned->report.gape->widest, gape, 0.02 * gape);
      const double other = gape_by_other_particles(scene, planned->tear, *options.material,
                                                   planned->report.gape->tension, 7);
      EXPECT_NEAR(other, gape, 0.15 * gape) << name;
    }
}

TEST(PlannedGape, is_told_only_if_it_is_wanted_and_can_be) {
  const GapingScene plain(0);
  const auto planned = plan_motion(plain.character, plain.target, plain.timing, plain.hand);
  ASSERT_TRUE(planned);
  EXPECT_FALSE(planned->report.gape);
  GapingScene wanted(0.01);
  wanted.target.is_closed = true;
  const auto closed = plan_motion(wanted.character, wanted.target, wanted.timing, wanted.hand);
  ASSERT_FALSE(closed);
  EXPECT_THAT(std::string(closed.error().text()), testing::HasSubstr("closed curve"));
  wanted.target.is_closed = false;
  wanted.target.gape = -1;
  const auto negative = plan_motion(wanted.character, wanted.target, wanted.timing, wanted.hand);
  ASSERT_FALSE(negative);
  EXPECT_THAT(std::string(negative.error().text()), testing::HasSubstr("the gape is -1"));
}

}  // namespace
}  // namespace sunder
