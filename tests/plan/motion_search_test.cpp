// The search of bench_plan, which judges plans, obeys the rule that plans obey.

#include "bench/plan/motion_search.h"

#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "bench/plan/link_gaps.h"
#include "pipeline/plan/link_pairs.h"
#include "plan/plan_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

BoneCollider ball_at(std::uint32_t link, const Vec3d& place, double radius) {
  BoneCollider of{link, {Collider::Sphere{radius}}};
  of.collider.place = place;
  return of;
}

BoneCollider rod(std::uint32_t link, double radius, double from, double to) {
  BoneCollider of{link, {Collider::Capsule{radius, 0.5 * (to - from)}}};
  of.collider.place = Vec3d(0, 0.5 * (from + to), 0);
  return of;
}

std::vector<Affine3d> frames_at(const PlanTool& tool, const std::vector<double>& values) {
  std::vector<Affine3d> frames(tool.robot.links.size());
  EXPECT_TRUE(RobotKinematics::create(tool.robot)->evaluate(values, frames));
  return frames;
}

TEST(LinkGaps, of_hand_made_shapes_are_known) {
  const Collider box{Collider::Box{Vec3d(1, 2, 3)}};
  Collider other{Collider::Box{Vec3d(1, 1, 1)}};
  other.place = Vec3d(3, 0, 0);
  EXPECT_NEAR(bench::gap_between(box, other), 1, 1e-4);
  other.turn = Quatd(Eigen::AngleAxisd(std::atan(1.0), Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(bench::gap_between(box, other), 2 - std::sqrt(2.0), 1e-4);  // an edge and a face
  other.place = Vec3d(2.2, 0, 0);
  EXPECT_LE(bench::gap_between(box, other), 0);
  Collider capsule{Collider::Capsule{0.5, 4}};
  capsule.place = Vec3d(1.8, 0, 0);
  EXPECT_NEAR(bench::gap_between(box, capsule), 0.3, 1e-4);
  capsule.place = Vec3d(1.4, 0, 0);
  EXPECT_NEAR(bench::gap_between(capsule, box), -0.1, 1e-4);
}

TEST(LinkGaps, of_a_folded_arm_are_known) {
  PlanTool tool = test::six_axis_arm(Vec3d::Zero());
  // Upper arm and wrist: joined by elbow and roll, which are not at one place.
  tool.shapes = {rod(2, 0.05, 0.1, 0.4), ball_at(4, Vec3d::Zero(), 0.04)};
  const bench::LinkGaps gaps(tool);
  ASSERT_EQ(gaps.pairs().size(), 1u);
  // The forearm is 0.4 long, the elbow 0.5 from the shoulder: folded by a right angle the wrist is
  // 0.4 beside it; by 2.5 it is 0.4 sin(2.5) beside and beyond 0.1 of the upper arm.
  EXPECT_NEAR(gaps.least(frames_at(tool, {0, 0, 1.5707963, 0, 0, 0}), 1),
              std::hypot(0.4, 0.1) - 0.09, 1e-4);
  EXPECT_NEAR(gaps.least(frames_at(tool, {0.3, 0.2, 2.5, 0, 0, 0}), 1), 0.4 * std::sin(2.5) - 0.09,
              1e-4);
  tool.shapes[0] = rod(2, 0.25, 0.1, 0.4);
  const std::vector<Affine3d> folded = frames_at(tool, {0.3, 0.2, 2.5, 0, 0, 0});
  EXPECT_NEAR(bench::gap_between(posed_collider(tool.shapes[0], folded[2]),
                                 posed_collider(tool.shapes[1], folded[4])),
              0.4 * std::sin(2.5) - 0.29, 1e-4);
}

TEST(LinkGaps, leave_out_the_pairs_that_plans_leave_out) {
  test::Random random(8);
  int kept = 0, overlapping = 0;
  for (int arm = 0; arm < 20; ++arm) {
    PlanTool tool = test::six_axis_arm(Vec3d::Zero());
    for (std::uint32_t link = 0; link < 7; ++link)
      tool.shapes.push_back(rod(link, random.uniform(0.01, 0.08), 0, random.uniform(0.05, 0.4)));
    const bench::LinkGaps gaps(tool);
    const plan::LinkPairs pairs(tool);
    kept += static_cast<int>(gaps.pairs().size());
    for (int pose = 0; pose < 40; ++pose) {
      std::vector<double> values;
      for (const RobotValue& value : tool.robot.values)
        values.push_back(random.uniform(value.lower, value.upper));
      const std::vector<Affine3d> frames = frames_at(tool, values);
      const double gap = gaps.least(frames, 0.02);
      const double by_plan = pairs.nearest(frames, 0.02).distance;
      overlapping += gap < 0 ? 1 : 0;
      EXPECT_NEAR(gap < 0, by_plan < 0, std::abs(gap) < 1e-5 ? 1 : 0) << arm << " " << pose;
      if (gap > 0) {
        EXPECT_NEAR(gap, by_plan, 1e-4);
      }
    }
  }
  EXPECT_GT(kept, 60);
  EXPECT_GT(overlapping, 20);
}

/// A curve on a tube that bends, before an arm.
bench::PlanCase tube_case() {
  bench::PlanCase made;
  made.rig = {"tube", std::make_shared<const Character>(test::make_tube(40, 24, 3)), 1};
  made.timing.pose = ClipPose{"Bend", 0.2};
  made.timing.clip_speed = 0.3;
  made.timing.cut = 2;
  std::vector<Vec3d> near;
  for (int i = 0; i <= 4; ++i) near.emplace_back(0.03 * i - 0.06, 0.6 + 0.02 * i, 0.3);
  made.target.places = test::nearest_places(
      made.rig.character, *make_pose(*made.rig.character, made.timing.pose), near);
  made.target.depth = {0.02};
  made.tool = test::six_axis_arm(Vec3d(0.2, 0.2, 1.0));
  made.middle_values = {0.3, 0.5, 0.7, 0.2, 0.5, 0.1};
  made.vertices.resize(made.tool.robot.links.size());
  return made;
}

std::vector<plan::TargetSample> samples_of(const bench::PlanCase& of) {
  const auto pose = make_pose(*of.rig.character, of.timing.pose);
  const auto path = plan::TargetPath::create(of.rig.character, of.target, *pose);
  return *plan::sample_target(*of.rig.character, *path, of.timing, 200);
}

bool is_found(const bench::PlanCase& of, int* judged = nullptr) {
  bench::LinkDepth links(of);
  return bench::MotionSearch(of, 0.004, links).find(samples_of(of), [&](const RobotTrajectory&) {
    if (judged != nullptr) ++*judged;
    return true;
  });
}

TEST(MotionSearch, finds_a_motion_with_slender_links) {
  bench::PlanCase of = tube_case();
  of.tool.shapes = {rod(0, 0.05, 0, 0.2), rod(2, 0.03, 0.1, 0.45), rod(3, 0.03, 0.1, 0.3)};
  int judged = 0;
  EXPECT_TRUE(is_found(of, &judged));
  EXPECT_EQ(judged, 1);
}

TEST(MotionSearch, passes_no_link_through_another_one) {
  bench::PlanCase of = tube_case();
  // A ball of the base before the curve, and one of the blade's link, 0.2 behind the tip: wherever
  // the blade is above the surface, they are nearer than their radii. The former is clear of the
  // tube, the latter need not be.
  const plan::TargetSample middle = samples_of(of)[100];
  const Vec3d before = of.tool.world_from_root.inverse() * (middle.place + 0.15 * middle.normal);
  of.tool.shapes = {ball_at(0, before, 0.05), ball_at(6, Vec3d(0, -0.1, 0), 0.33)};
  ASSERT_EQ(bench::LinkGaps(of.tool).pairs().size(), 1u);
  int judged = 0;
  EXPECT_FALSE(is_found(of, &judged));
  EXPECT_EQ(judged, 0);
  of.tool.shapes.pop_back();  // the blade's link has no shape: it passes
  EXPECT_TRUE(is_found(of));
}

}  // namespace
}  // namespace sunder
