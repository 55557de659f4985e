// Curves that are hard: across a seam, across two meshes, where they cross themselves, on a limb
// that turns about itself. Each ends with a wound, or with what is in the way.

#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plan/plan_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

Result<PlannedMotion> plan_by_hand(const std::shared_ptr<const Character>& character,
                                   const WoundTarget& target, const PlanTiming& timing) {
  const auto hand = free_hand(character, target, timing, 0.1);
  if (!hand) return hand.error();
  return plan_motion(character, target, timing, *hand);
}

/// A plan keeps its tolerance, or says what is in the way.
void expect_answer(const Result<PlannedMotion>& planned) {
  ASSERT_TRUE(planned) << planned.error().text();
  const PlanReport& report = planned->report;
  if (report.is_reachable) {
    EXPECT_LE(report.hausdorff, report.tolerance);
    EXPECT_FALSE(planned->trajectory.times.empty());
  } else {
    EXPECT_FALSE(report.obstacles.empty());
  }
}

TEST(DegenerateCurves, across_the_seam_of_a_tube) {
  const auto tube = std::make_shared<const Character>(test::make_tube(40, 24, 3));
  PlanTiming timing;
  timing.pose = ClipPose{"Bend", 0.2};
  std::vector<Vec3d> near;  // the seam is on the side of +x
  for (int i = 0; i <= 8; ++i) near.emplace_back(0.6, 0.6 + 0.02 * i, 0.03 * (i - 4));
  WoundTarget target;
  target.places = test::nearest_places(tube, *make_pose(*tube, timing.pose), near);
  target.depth = {0.02};
  const auto planned = plan_by_hand(tube, target, timing);
  expect_answer(planned);
  EXPECT_TRUE(planned->report.is_reachable);
}

TEST(DegenerateCurves, along_itself_there_and_back) {
  const auto sheet = std::make_shared<const Character>(test::make_sheet(20));
  PlanTiming timing;
  timing.pose = BindPose{};
  WoundTarget target;
  target.places =
      test::nearest_places(sheet, *make_pose(*sheet, timing.pose),
                           {Vec3d(0.3, 0.4, 0), Vec3d(0.7, 0.5, 0), Vec3d(0.3, 0.4, 0)});
  expect_answer(plan_by_hand(sheet, target, timing));
}

TEST(DegenerateCurves, across_two_meshes_that_touch) {
  Character both = test::make_sheet(12);
  Mesh beside = both.meshes[0];
  beside.name = "beside";
  for (Vec3f& place : beside.positions) place.x() += 1;
  both.meshes.push_back(beside);
  const auto character = std::make_shared<const Character>(std::move(both));
  PlanTiming timing;
  timing.pose = BindPose{};
  WoundTarget target;
  target.places = test::nearest_places(character, *make_pose(*character, timing.pose),
                                       {Vec3d(0.8, 0.4, 0), Vec3d(1.2, 0.5, 0)});
  ASSERT_NE(target.places[0].mesh, target.places[1].mesh);
  expect_answer(plan_by_hand(character, target, timing));
}

TEST(DegenerateCurves, across_two_meshes_with_a_gap_are_refused_by_their_places) {
  Character both = test::make_sheet(12);
  Mesh beside = both.meshes[0];
  beside.name = "beside";
  for (Vec3f& place : beside.positions) place.x() += 1.3f;
  both.meshes.push_back(beside);
  const auto character = std::make_shared<const Character>(std::move(both));
  PlanTiming timing;
  timing.pose = BindPose{};
  WoundTarget target;
  target.places = test::nearest_places(character, *make_pose(*character, timing.pose),
                                       {Vec3d(0.8, 0.4, 0), Vec3d(1.5, 0.5, 0)});
  const auto planned = plan_by_hand(character, target, timing);
  ASSERT_FALSE(planned);
  EXPECT_EQ(planned.error().code(), StatusCode::invalid_argument);
  EXPECT_THAT(std::string(planned.error().text()), testing::HasSubstr("places 0 and 1"));
}

TEST(DegenerateCurves, on_a_limb_that_turns_by_180_degrees) {
  Character limb = test::make_tube(40, 24, 3);
  Clip turn{"Turn", 1.0f, {}};
  Channel channel;
  channel.target = ChannelTarget::rotation;
  channel.index = 1;
  channel.width = 4;
  channel.times = {0, 0.5f, 1};
  const float half = std::sqrt(0.5f);
  channel.values = {0, 0, 0, 1, 0, half, 0, half, 0, 1, 0, 0};
  turn.channels.push_back(channel);
  limb.clips.push_back(turn);
  const auto character = std::make_shared<const Character>(std::move(limb));
  PlanTiming timing;
  timing.pose = ClipPose{"Turn", 0};
  timing.clip_speed = 1;                         // half a turn within the second of the cut
  for (const double first : {0.5, 0.85, 1.4}) {  // below, across and above the joint
    std::vector<Vec3d> near;
    for (int i = 0; i <= 8; ++i) near.emplace_back(0.02 * i, first + 0.03 * i, 0.6);
    WoundTarget target;
    target.places = test::nearest_places(character, *make_pose(*character, timing.pose), near);
    target.depth = {0.02};
    expect_answer(plan_by_hand(character, target, timing));
  }
}

}  // namespace
}  // namespace sunder
