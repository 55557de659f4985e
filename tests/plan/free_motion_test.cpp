// Links stay outside of the character where the blade must lean, and where a robot would have to
// stand: seeded random arms, checked against vertices of the tests' reference.

#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/contact.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plan/plan_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

constexpr double kAllowed = 0.003;  ///< Metres: vertices are about as dense as what plans look at.

struct FreeScene {
  std::shared_ptr<const Character> character =
      std::make_shared<const Character>(test::make_tube(40, 24, 3));
  PlanTiming timing;
  WoundTarget target;
  PlanOptions options;
  FreeScene() {
    timing.pose = ClipPose{"Bend", 0.2};
    timing.clip_speed = 0.5;
    target.depth = {0.02};
    options.tolerance = 0.004;
  }
};

PlanTool arm_with_capsules(const Vec3d& place) {
  PlanTool tool = test::six_axis_arm(place);
  const auto capsule = [&](std::uint32_t link, double radius, double from, double to) {
    tool.shapes.push_back(
        {link, {Collider::Capsule{radius, 0.5 * (to - from)}, Vec3d(0, 0.5 * (from + to), 0)}});
  };
  capsule(0, 0.06, 0, 0.2);
  capsule(2, 0.05, 0, 0.5);
  capsule(3, 0.04, 0, 0.4);
  capsule(5, 0.03, 0, 0.05);
  return tool;
}

/// The least distance of posed vertices from capsules and balls, by distances from their cores.
double least_link_distance(const FreeScene& scene, const PlanTool& tool,
                           const RobotTrajectory& trajectory) {
  const auto motion = RobotMotion::create(tool.robot, trajectory);
  std::vector<Affine3d> frames(tool.robot.links.size());
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 60; ++i) {
    const double time = motion->last_time() * i / 60;
    EXPECT_TRUE(motion->pose_at(time, frames, tool.world_from_root));
    ClipPose clip = std::get<ClipPose>(scene.timing.pose);
    clip.time += scene.timing.clip_speed * time;
    const auto posed =
        test::posed_positions(*scene.character, 0, *make_pose(*scene.character, clip));
    for (const BoneCollider& shape : tool.shapes) {
      const auto* const capsule = std::get_if<Collider::Capsule>(&shape.collider.shape);
      const Vec3d half(0, capsule != nullptr ? capsule->half_length : 0, 0);
      const double radius = capsule != nullptr
                                ? capsule->radius
                                : std::get<Collider::Sphere>(shape.collider.shape).radius;
      const Vec3d begin = frames[shape.bone] * Vec3d(shape.collider.place - half);
      const Vec3d along = frames[shape.bone] * Vec3d(shape.collider.place + half) - begin;
      for (const Vec3d& vertex : posed) {
        const double share =
            along.norm() > 0
                ? std::clamp((vertex - begin).dot(along) / along.squaredNorm(), 0.0, 1.0)
                : 0.0;
        least = std::min(least, (vertex - begin - share * along).norm() - radius);
      }
    }
  }
  return least;
}

/// A random place beside the middle of the curve.
Vec3d beside_curve(const FreeScene& scene, const ModelPose& pose, test::Random& random) {
  const auto model = TornModel::create(scene.character);
  auto query = SurfaceQuery::create(*model);
  EXPECT_TRUE(query->set_pose(pose));
  const SurfaceContact at = **query->locate(scene.target.places[8]);
  return at.place + random.uniform(0.4, 0.9) * at.normal + 0.4 * random.direction();
}

TEST(FreeMotion, random_arms_and_curves_keep_limits_and_links_outside) {
  test::Random random(23);
  int made = 0, refused = 0;
  for (int i = 0; i < 12; ++i) {
    FreeScene scene;
    const ModelPose pose = *make_pose(*scene.character, scene.timing.pose);
    scene.target.places =
        test::random_curve(scene.character, pose, random.uniform(0.1, 0.25), random);
    if (scene.target.places.size() < 2) continue;
    const PlanTool tool = arm_with_capsules(beside_curve(scene, pose, random));
    const auto planned =
        plan_motion(scene.character, scene.target, scene.timing, tool, scene.options);
    ASSERT_TRUE(planned) << planned.error().text();
    const PlanReport& report = planned->report;
    EXPECT_EQ(report.is_reachable, report.obstacles.empty());
    if (!report.is_reachable) {
      ++refused;
      continue;
    }
    ++made;
    EXPECT_LE(report.hausdorff, report.tolerance);
    EXPECT_TRUE(RobotMotion::create(tool.robot, planned->trajectory)->excesses().empty());
    EXPECT_GT(least_link_distance(scene, tool, planned->trajectory), -kAllowed) << i;
  }
  EXPECT_GT(made, 2);
  EXPECT_GT(refused, 0);
}

/// A curve in front of the tube.
void lay_front_curve(FreeScene& scene) {
  const ModelPose pose = *make_pose(*scene.character, scene.timing.pose);
  std::vector<Vec3d> near;
  for (int i = 0; i <= 8; ++i) near.emplace_back(0.02 * i - 0.08, 0.6 + 0.02 * i, 0.3);
  scene.target.places = test::nearest_places(scene.character, pose, near);
}

TEST(FreeMotion, the_blade_leans_where_a_link_would_be_inside) {
  FreeScene scene;
  lay_front_curve(scene);
  PlanTool tool = arm_with_capsules(Vec3d(0.2, 0.2, 1.0));
  const auto upright =
      plan_motion(scene.character, scene.target, scene.timing, tool, scene.options);
  ASSERT_TRUE(upright->report.is_reachable);
  // Balls around the wrist that touch the surface if the blade is perpendicular to it.
  for (const double side : {-1.0, 1.0})
    tool.shapes.push_back({5, {Collider::Sphere{0.05}, Vec3d(0, 0.13, 0.14 * side)}});
  const auto leaning =
      plan_motion(scene.character, scene.target, scene.timing, tool, scene.options);
  ASSERT_TRUE(leaning) << leaning.error().text();
  ASSERT_TRUE(leaning->report.is_reachable);
  EXPECT_GT(leaning->report.mean_angle_error, 1.5 * upright->report.mean_angle_error);
  EXPECT_GT(least_link_distance(scene, tool, leaning->trajectory), -kAllowed);
  EXPECT_LE(leaning->report.hausdorff, leaning->report.tolerance);
  const auto again = plan_motion(scene.character, scene.target, scene.timing, tool, scene.options);
  EXPECT_EQ(again->trajectory.values, leaning->trajectory.values);
}

TEST(FreeMotion, a_base_from_which_the_curve_is_made_is_near) {
  FreeScene scene;
  lay_front_curve(scene);
  const Vec3d places[] = {Vec3d(0.2, 0.2, 2.2), Vec3d(0.1, 0.3, 0.05)};  // too far, and inside
  for (const Vec3d& place : places) {
    PlanTool tool = arm_with_capsules(place);
    const auto stuck =
        plan_motion(scene.character, scene.target, scene.timing, tool, scene.options);
    ASSERT_FALSE(stuck->report.is_reachable);
    const auto base = find_base(scene.character, scene.target, scene.timing, tool, scene.options);
    ASSERT_TRUE(base) << base.error().text();
    ASSERT_TRUE(base->has_value());
    tool.world_from_root.translation() += (*base)->moved;
    const auto there =
        plan_motion(scene.character, scene.target, scene.timing, tool, scene.options);
    EXPECT_TRUE(there->report.is_reachable);
    EXPECT_EQ(there->trajectory.values, (*base)->planned.trajectory.values);
    EXPECT_GT(least_link_distance(scene, tool, there->trajectory), -kAllowed);
    EXPECT_LT((*base)->moved.norm(), 2.2);
  }
}

TEST(FreeMotion, no_base_for_a_limit_that_no_place_helps_and_bad_input_is_named) {
  FreeScene scene;
  lay_front_curve(scene);
  PlanTool tool = arm_with_capsules(Vec3d(0.2, 0.2, 1.0));
  std::get<Collider::Capsule>(tool.shapes[3].collider.shape).radius = 0.3;  // wider than the blade
  const auto base = find_base(scene.character, scene.target, scene.timing, tool, scene.options);
  ASSERT_TRUE(base) << base.error().text();
  EXPECT_FALSE(base->has_value());
  scene.timing.cut = -1;
  const auto bad = find_base(scene.character, scene.target, scene.timing, tool, scene.options);
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().text(), testing::HasSubstr("the cut takes -1 s"));
}

}  // namespace
}  // namespace sunder
