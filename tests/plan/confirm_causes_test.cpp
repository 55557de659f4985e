// What a plan names is taken away in further plans, until that is all that has to go.

#include "pipeline/plan/confirm_causes.h"

#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "plan/plan_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using Kind = PlanObstacle::Kind;

PlanReport stopped_by(std::vector<PlanObstacle> obstacles) {
  PlanReport report;
  report.obstacles = std::move(obstacles);
  return report;
}

/// An arm with a ball on each of its links.
PlanTool arm_with_balls() {
  PlanTool tool = test::six_axis_arm(Vec3d::Zero());
  for (std::uint32_t link = 1; link < 6; ++link)
    tool.shapes.push_back({link, {Collider::Sphere{0.05}}});
  return tool;
}

/// Names the first ball that is left, until `free` of them are gone.
Result<PlannedMotion> stopped_by_first_ball(const plan::FreedInputs& inputs, std::size_t free) {
  PlannedMotion planned;
  planned.report.is_reachable = inputs.tool.shapes.size() + free <= 5;
  if (!planned.report.is_reachable)
    planned.report.obstacles = {
        {Kind::collision, inputs.tool.robot.links[inputs.tool.shapes[0].bone].name, 0.5}};
  return planned;
}

TEST(ConfirmCauses, names_all_links_that_have_to_go) {
  const PlanTool tool = arm_with_balls();
  PlanReport report = stopped_by({{Kind::collision, "turn", 0.2}});
  int plans = 0;
  ASSERT_TRUE(plan::confirm_causes(
      tool, {},
      [&](const plan::FreedInputs& inputs) {
        ++plans;
        return stopped_by_first_ball(inputs, 3);
      },
      report));
  EXPECT_EQ(plans, 3);
  ASSERT_EQ(report.obstacles.size(), 3u);
  EXPECT_EQ(report.obstacles[1].value, "shoulder");
  EXPECT_EQ(report.obstacles[2].value, "elbow");
}

TEST(ConfirmCauses, ends_where_another_kind_stops_the_blade_or_nothing_new) {
  const PlanTool tool = arm_with_balls();
  for (const PlanObstacle& next : {PlanObstacle{Kind::joint_speed, "elbow", 0.5},
                                   PlanObstacle{Kind::collision, "turn", 0.7}}) {
    PlanReport report = stopped_by({{Kind::collision, "turn", 0.2}});
    ASSERT_TRUE(plan::confirm_causes(
        tool, {},
        [&](const plan::FreedInputs&) -> Result<PlannedMotion> {
          PlannedMotion planned;
          planned.report.obstacles = {next};
          return planned;
        },
        report));
    EXPECT_EQ(report.obstacles.size(), 1u);
  }
}

TEST(ConfirmCauses, needs_no_plan_for_limits_and_reach) {
  for (const Kind kind : {Kind::joint_limit, Kind::reach, Kind::wound}) {
    PlanReport report = stopped_by({{kind, "", 0.2}});
    ASSERT_TRUE(plan::confirm_causes(
        arm_with_balls(), {},
        [](const plan::FreedInputs&) -> Result<PlannedMotion> {
          ADD_FAILURE();
          return PlannedMotion{};
        },
        report));
    EXPECT_EQ(report.obstacles.size(), 1u);
  }
}

TEST(ConfirmCauses, frees_what_is_named_alone) {
  const PlanTool tool = arm_with_balls();
  PlanOptions options;
  options.maximum_acceleration = 2;
  const plan::FreedInputs freed = plan::freed_inputs(
      tool, options, stopped_by({{Kind::joint_speed, "elbow", 0}, {Kind::collision, "bend", 0}}));
  for (std::size_t i = 0; i < tool.robot.joints.size(); ++i)
    EXPECT_DOUBLE_EQ(freed.tool.robot.joints[i].velocity,
                     (i == 2 ? 10 : 1) * tool.robot.joints[i].velocity);
  EXPECT_EQ(freed.tool.shapes.size(), tool.shapes.size() - 1);
  EXPECT_EQ(freed.options.maximum_acceleration, 2);
  EXPECT_EQ(plan::freed_inputs(tool, options, stopped_by({{Kind::acceleration, "elbow", 0}}))
                .options.maximum_acceleration,
            20);
}

TEST(ConfirmCauses, of_slow_arms_are_all_that_has_to_be_faster) {
  const auto tube = std::make_shared<const Character>(test::make_tube(40, 24, 3));
  PlanTiming timing;
  timing.pose = ClipPose{"Bend", 0.2};
  const ModelPose pose = *make_pose(*tube, timing.pose);
  std::vector<Vec3d> near;
  for (int i = 0; i <= 12; ++i) near.emplace_back(0.1 * std::sin(i / 3.0), 0.55 + 0.025 * i, 0.3);
  WoundTarget target;
  target.places = test::nearest_places(tube, pose, near);
  target.depth = {0.02};
  for (const double speed : {0.15, 0.3}) {
    PlanTool tool = test::six_axis_arm(Vec3d(0.2, 0.2, 1.0));
    for (RobotJoint& joint : tool.robot.joints) joint.velocity = speed;
    const auto planned = plan_motion(tube, target, timing, tool);
    ASSERT_TRUE(planned) << planned.error().text();
    ASSERT_FALSE(planned->report.is_reachable);
    const plan::FreedInputs freed = plan::freed_inputs(tool, {}, planned->report);
    const auto again = plan_motion(tube, target, timing, freed.tool);
    ASSERT_TRUE(again);
    EXPECT_TRUE(again->report.is_reachable) << speed;
  }
}

}  // namespace
}  // namespace sunder
