// Links of a planned motion stay outside of one another.

#include "pipeline/plan/link_pairs.h"

#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plan/plan_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

Collider random_collider(test::Random& random, std::uint32_t kind) {
  Collider collider{Collider::Sphere{random.uniform(0.05, 0.2)}};
  collider.place = 0.6 * random.uniform(0, 1) * random.direction();
  collider.turn =
      Quatd(Eigen::AngleAxisd(random.uniform(0, 3), Eigen::Vector3d(random.direction())));
  if (kind == 1)
    collider.shape = Collider::Capsule{random.uniform(0.05, 0.1), random.uniform(0, 0.3)};
  if (kind == 2)
    collider.shape = Collider::Box{
        Vec3d(random.uniform(0.05, 0.2), random.uniform(0.05, 0.2), random.uniform(0.05, 0.2))};
  return collider;
}

/// Places within a collider: of its surface, and inside.
std::vector<Vec3d> places_of(const Collider& collider, test::Random& random, int count) {
  std::vector<Vec3d> places;
  for (int i = 0; i < count; ++i) {
    Vec3d local = Vec3d::Zero();
    if (const auto* const ball = std::get_if<Collider::Sphere>(&collider.shape))
      local = ball->radius * random.direction();
    if (const auto* const capsule = std::get_if<Collider::Capsule>(&collider.shape))
      local = Vec3d(0, random.uniform(-1, 1) * capsule->half_length, 0) +
              capsule->radius * random.direction();
    if (const auto* const box = std::get_if<Collider::Box>(&collider.shape)) {
      for (int k = 0; k < 3; ++k) local[k] = random.uniform(-1, 1) * box->half_size[k];
      const int face = static_cast<int>(random.index(3));
      local[face] = (i % 2 == 0 ? 1 : -1) * box->half_size[face];
      if (i % 8 == 0)  // an edge
        local[(face + 1) % 3] = (i % 16 == 0 ? 1 : -1) * box->half_size[(face + 1) % 3];
    }
    places.push_back(collider.place + collider.turn * local);
  }
  return places;
}

TEST(LinkPairs, distances_agree_with_places_on_the_shapes) {
  test::Random random(3);
  for (int i = 0; i < 150; ++i) {
    const Collider a = random_collider(random, random.index(3));
    const Collider b = random_collider(random, random.index(3));
    double sampled = std::numeric_limits<double>::infinity();
    for (const Vec3d& place : places_of(a, random, 3000))
      sampled = std::min(sampled, distance_to(b, place).distance);
    for (const Vec3d& place : places_of(b, random, 3000))
      sampled = std::min(sampled, distance_to(a, place).distance);
    const double distance = plan::distance_between(a, b);
    EXPECT_NEAR(distance, plan::distance_between(b, a), 1e-7);
    const bool are_boxes = a.shape.index() == 2 && b.shape.index() == 2;
    // Of boxes that are apart it is a lower bound; what overlaps is deeper than samples say.
    EXPECT_LE(distance, sampled + 1e-9) << i;
    if (sampled > 0.05) {
      EXPECT_GT(distance, are_boxes ? 0 : sampled - 0.02) << i;
    }
  }
}

std::shared_ptr<const Character> bent_tube() {
  static const auto made = std::make_shared<const Character>(test::make_tube(40, 24, 3));
  return made;
}

PlanTiming while_tube_bends() {
  PlanTiming timing;
  timing.pose = ClipPose{"Bend", 0.2};
  timing.clip_speed = 0.5;
  return timing;
}

/// A short curve in front of the tube.
WoundTarget oblique_curve(double height) {
  std::vector<Vec3d> near;
  for (int i = 0; i <= 8; ++i) near.emplace_back(0.02 * i - 0.08, height + 0.02 * i, 0.3);
  WoundTarget target;
  target.places =
      test::nearest_places(bent_tube(), *make_pose(*bent_tube(), while_tube_bends().pose), near);
  target.depth = {0.02};
  return target;
}

BoneCollider capsule(std::uint32_t link, double radius, double from, double to) {
  BoneCollider of{link, {Collider::Capsule{radius, 0.5 * (to - from)}}};
  of.collider.place = Vec3d(0, 0.5 * (from + to), 0);
  return of;
}

/// The arm with thick links.
PlanTool thick_arm(const Vec3d& place) {
  PlanTool tool = test::six_axis_arm(place);
  tool.shapes = {capsule(0, 0.09, 0, 0.25), capsule(2, 0.05, 0.1, 0.45),
                 capsule(3, 0.05, 0.1, 0.35), capsule(6, 0.04, -0.04, 0)};
  return tool;
}

/// The deepest overlap of links that the same joints do not place at one point, at 500 times, from
/// places on the shapes.
double deepest_overlap(const PlanTool& tool, const RobotTrajectory& trajectory) {
  const auto motion = RobotMotion::create(tool.robot, trajectory);
  std::vector<Affine3d> frames(tool.robot.links.size());
  test::Random random(5);
  std::vector<std::vector<Vec3d>> places;  // in the frames of links
  for (const BoneCollider& shape : tool.shapes)
    places.push_back(places_of(shape.collider, random, 150));
  double deepest = 0;
  for (int i = 0; i <= 500; ++i) {
    if (!motion->pose_at(motion->last_time() * i / 500, frames, tool.world_from_root)) return 1;
    for (std::size_t a = 0; a < tool.shapes.size(); ++a)
      for (std::size_t b = 0; b < tool.shapes.size(); ++b) {
        const std::uint32_t of = tool.shapes[a].bone, other = tool.shapes[b].bone;
        // Neighbours, and what two joints at one place join.
        if (std::max(of, other) - std::min(of, other) <= 1) continue;
        if (std::max(of, other) == 2 && std::min(of, other) == 0) continue;
        const Collider posed = posed_collider(tool.shapes[b], frames[other]);
        for (const Vec3d& place : places[a])
          deepest = std::max(deepest, -distance_to(posed, frames[of] * place).distance);
      }
  }
  return deepest;
}

TEST(LinkPairs, of_planned_motions_stay_apart) {
  const PlanTiming timing = while_tube_bends();
  int planned_count = 0, overlapping_without = 0;
  for (const double height : {0.35, 0.8})
    for (const double away : {0.45, 0.6, 0.8}) {
      const WoundTarget target = oblique_curve(height);
      const PlanTool tool = thick_arm(Vec3d(0.1, 0.2, 0.2 + away));
      PlanTool bare = tool;
      bare.shapes.clear();
      const auto without = plan_motion(bent_tube(), target, timing, bare);
      ASSERT_TRUE(without);
      if (without->report.is_reachable && deepest_overlap(tool, without->trajectory) > 0.001)
        ++overlapping_without;
      const auto planned = plan_motion(bent_tube(), target, timing, tool);
      ASSERT_TRUE(planned) << planned.error().text();
      if (!planned->report.is_reachable) continue;
      ++planned_count;
      EXPECT_GT(planned->report.least_self_clearance, 0);
      EXPECT_EQ(deepest_overlap(tool, planned->trajectory), 0) << height << " " << away;
    }
  EXPECT_GE(planned_count, 3);
  EXPECT_GE(overlapping_without, 1);
}

TEST(LinkPairs, that_stop_the_blade_are_both_named) {
  const PlanTiming timing = while_tube_bends();
  PlanTool tool = test::six_axis_arm(Vec3d(0.2, 0.2, 1.0));
  const WoundTarget target = oblique_curve(0.6);
  // A ball of the base before the tube.
  BoneCollider before{0, {Collider::Sphere{0.05}}};
  before.collider.place = tool.world_from_root.inverse() * Vec3d(0, 0.65, 0.63);
  tool.shapes = {before};
  const auto free = plan_motion(bent_tube(), target, timing, tool);
  ASSERT_TRUE(free && free->report.is_reachable);
  EXPECT_EQ(free->report.least_self_clearance, std::numeric_limits<double>::infinity());
  // One of the blade's link, 0.2 behind the tip: at the curve they cannot but overlap.
  BoneCollider around{6, {Collider::Sphere{0.4}}};
  around.collider.place = Vec3d(0, -0.1, 0);
  tool.shapes.push_back(around);
  const auto stopped = plan_motion(bent_tube(), target, timing, tool);
  ASSERT_TRUE(stopped) << stopped.error().text();
  ASSERT_FALSE(stopped->report.is_reachable);
  ASSERT_FALSE(stopped->report.obstacles.empty());
  const PlanObstacle& obstacle = stopped->report.obstacles[0];
  EXPECT_EQ(obstacle.kind, PlanObstacle::Kind::self_collision);
  const std::vector<std::string> named = {obstacle.value, obstacle.other};
  EXPECT_THAT(named, testing::UnorderedElementsAre("base", "twist"));
}

TEST(LinkPairs, of_a_joint_with_several_axes_are_neighbours) {
  PlanTool tool = test::six_axis_arm(Vec3d::Zero());
  tool.shapes = {capsule(0, 0.05, 0, 0.2), capsule(2, 0.05, 0.1, 0.4)};
  EXPECT_TRUE(plan::LinkPairs(tool).is_empty());  // "turn" and "shoulder" are at one place
  tool.shapes[1].bone = 3;
  EXPECT_FALSE(plan::LinkPairs(tool).is_empty());
  tool.shapes[1].bone = 2;
  tool.robot.joints[1].parent_from_joint.translation() = Vec3d(0, 0.2, 0);
  EXPECT_FALSE(plan::LinkPairs(tool).is_empty());
}

TEST(LinkPairs, shapes_that_overlap_at_rest_are_left_out) {
  PlanTool tool = test::six_axis_arm(Vec3d::Zero());
  tool.robot.joints[1].parent_from_joint.translation() = Vec3d(0, 0.15, 0);
  tool.shapes = {capsule(0, 0.1, 0, 0.4), capsule(2, 0.1, 0, 0.4), capsule(4, 0.04, 0, 0.05)};
  const auto kinematics = RobotKinematics::create(tool.robot);
  std::vector<Affine3d> frames(tool.robot.links.size());
  ASSERT_TRUE(kinematics->evaluate(rest_values(tool.robot), frames));
  ASSERT_LT(plan::distance_between(posed_collider(tool.shapes[0], frames[0]),
                                   posed_collider(tool.shapes[1], frames[2])),
            0);
  const plan::LinkPairs pairs(tool);
  EXPECT_FALSE(pairs.is_empty());
  EXPECT_TRUE(pairs.overlaps(frames).empty());
}

}  // namespace
}  // namespace sunder
