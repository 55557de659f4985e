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
    target.gape = {gape};
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

/// A share of the curve's length by a place's height.
double share_at(const Vec3d& place) { return (place.y() - 0.55) / 0.3; }

/// What a wound gapes at a share of its length that is widest at a third of it.
double drop_at(double share, double widest) {
  if (share <= 0 || share >= 1) return 0;
  return widest * std::sqrt(share) * (1 - share) / (std::sqrt(1.0 / 3) * 2 / 3);
}

/// The largest difference of gape and drop along a wound that opens under the planned tension in
/// particles of another range and seed; pairs of lips in the first and last tenth do not count.
double error_by_other_particles(const GapingScene& scene, const PlannedMotion& planned,
                                const SoftMaterial& material, double widest) {
  auto model = TornModel::create(scene.character);
  const ModelPose pose = *make_pose(*scene.character, scene.timing.pose);
  auto set = ParticleSet::create(*model, pose, {0.03, false, 5});
  auto body = SoftBody::create(*set, pose, {&material, 1});
  std::vector<ChangeRecord> changes;
  EXPECT_TRUE(apply_operation(*model, planned.tear, &changes));
  EXPECT_TRUE(set->follow(*model, changes));
  while (set->settle(*model)) continue;
  auto tension = tension_of_gape(scene.target, scene.timing, planned, *model, changes);
  EXPECT_TRUE(tension) << tension.error().text();
  EXPECT_TRUE(body->set_tension(*tension));
  for (int i = 0; i < 600 && (i == 0 || body->awake_count() > 0); ++i)
    EXPECT_TRUE(body->step(*model, pose, 1.0 / 30));
  const std::vector<Vec3d> posed = test::posed_positions(model->character(), 0, pose);
  std::vector<Vec3d> place_of_point(model->character().meshes[0].vertex_count() + posed.size());
  const Mesh& mesh = model->character().meshes[0];
  for (std::uint32_t triangle = 0; triangle < mesh.triangle_count(); ++triangle)
    for (std::uint32_t corner = 0; corner < 3 && !is_retired(mesh.triangles[triangle]); ++corner)
      place_of_point.at(model->point_at(0, triangle, corner)) =
          posed[mesh.triangles[triangle][corner]];
  double most = 0;
  for (const ChangeRecord& change : changes)
    for (const LipPair& lip : change.lips) {
      const double share = share_at(place_of_point.at(lip.left));
      if (share < 0.1 || share > 0.9) continue;
      const double gape =
          (body->point_displacement(lip.left) - body->point_displacement(lip.right)).norm();
      most = std::max(most, std::abs(gape - drop_at(share, widest)));
    }
  return most;
}

TEST(PlannedGape, follows_a_profile_along_the_curve) {
  constexpr double kWidest = 0.02;
  GapingScene scene(0);
  scene.target.gape.clear();
  for (int i = 0; i <= 12; ++i) scene.target.gape.push_back(drop_at(i / 12.0, kWidest));
  PlanOptions options;
  options.material = *find_material("skin");
  const auto planned =
      plan_motion(scene.character, scene.target, scene.timing, scene.hand, options);
  ASSERT_TRUE(planned) << planned.error().text();
  ASSERT_TRUE(planned->report.gape);
  const PlannedGape& gape = *planned->report.gape;
  ASSERT_EQ(gape.tension_shares.size(), gape.gape_along.size());
  EXPECT_LE(gape.most_error, 0.1 * kWidest);
  for (const double share : gape.tension_shares) EXPECT_TRUE(share >= 0 && share <= 1) << share;
  EXPECT_LE(error_by_other_particles(scene, *planned, *options.material, kWidest), 0.15 * kWidest);
}

TEST(PlannedGape, of_a_profile_is_closed_at_both_ends) {
  GapingScene scene(0);
  scene.target.gape.assign(13, 0.01);
  const auto open = plan_motion(scene.character, scene.target, scene.timing, scene.hand);
  ASSERT_FALSE(open);
  EXPECT_THAT(std::string(open.error().text()), testing::HasSubstr("a wound is closed there"));
  scene.target.gape = {0, 0.01};
  const auto short_one = plan_motion(scene.character, scene.target, scene.timing, scene.hand);
  ASSERT_FALSE(short_one);
  EXPECT_EQ(short_one.error().code(), StatusCode::size_mismatch);
  scene.target.gape = {0};
  const auto none = plan_motion(scene.character, scene.target, scene.timing, scene.hand);
  ASSERT_TRUE(none) << none.error().text();
  EXPECT_EQ(
      tension_of_gape(scene.target, scene.timing, *none, *TornModel::create(scene.character), {})
          .error()
          .code(),
      StatusCode::invalid_argument);
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
  wanted.target.gape = {-1};
  const auto negative = plan_motion(wanted.character, wanted.target, wanted.timing, wanted.hand);
  ASSERT_FALSE(negative);
  EXPECT_THAT(std::string(negative.error().text()), testing::HasSubstr("gape 0 is -1"));
}

}  // namespace
}  // namespace sunder
