// The motion that is planned makes the wound that was asked for, within the limits of the tool.

#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plan/plan_scene.h"
#include "robot/planar_arm.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using testing::HasSubstr;

std::shared_ptr<const Character> tube() {
  static const auto made = std::make_shared<const Character>(test::make_tube(40, 24, 3));
  return made;
}

PlanTiming while_it_bends() {
  PlanTiming timing;
  timing.pose = ClipPose{"Bend", 0.2};
  timing.clip_speed = 0.5;
  return timing;
}

ModelPose pose_at(const Character& character, const PlanTiming& timing, double time) {
  ClipPose pose = std::get<ClipPose>(timing.pose);
  pose.time += timing.clip_speed * time;
  return *make_pose(character, pose);
}

/// A curve in front of the tube, on the side of +z.
WoundTarget front_curve(const PlanTiming& timing) {
  const ModelPose pose = *make_pose(*tube(), timing.pose);
  std::vector<Vec3d> near;
  for (int i = 0; i <= 12; ++i) {
    const double share = i / 12.0;
    near.emplace_back(0.1 * std::sin(4 * share), 0.55 + 0.3 * share, 0.3);
  }
  WoundTarget target;
  target.places = test::nearest_places(tube(), pose, near);
  target.depth = {0.02};
  return target;
}

double to_polyline(const Vec3d& place, const std::vector<Vec3d>& line) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec3d along = line[i] - line[i - 1];
    const double square = along.squaredNorm();
    const double share =
        square > 0 ? std::clamp((place - line[i - 1]).dot(along) / square, 0.0, 1.0) : 0;
    least = std::min(least, (line[i - 1] + share * along - place).norm());
  }
  return least;
}

/// The given places of a curve in a pose, by the reference of the tests.
std::vector<Vec3d> posed_curve(const Character& character, const WoundTarget& target,
                               const ModelPose& pose) {
  std::vector<Vec3d> line;
  for (const SurfaceAnchor& anchor : target.places) {
    const std::vector<Vec3d> posed = test::posed_positions(character, anchor.mesh, pose);
    Vec3d place = Vec3d::Zero();
    for (std::size_t i = 0; i < 3; ++i)
      place += anchor.birth.barycentric[i] *
               posed[character.meshes[anchor.mesh].triangles[anchor.birth.triangle][i]];
    line.push_back(place);
  }
  return line;
}

/// Tears a copy and checks that all new vertices lie near the curve and that the whole curve has
/// new vertices near it.
void expect_torn_along(const std::shared_ptr<const Character>& character, const TearOperation& tear,
                       const WoundTarget& target, const ModelPose& pose, double tolerance) {
  auto model = TornModel::create(character);
  const auto report = apply_operation(*model, tear);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_GE(report->runs, 1u);
  const std::vector<Vec3d> line = posed_curve(*character, target, pose);
  std::vector<Vec3d> found;
  for (std::uint32_t mesh = 0; mesh < character->meshes.size(); ++mesh) {
    const std::vector<Vec3d> posed = test::posed_positions(model->character(), mesh, pose);
    for (std::size_t v = character->meshes[mesh].vertex_count(); v < posed.size(); ++v)
      found.push_back(posed[v]);
  }
  ASSERT_FALSE(found.empty());
  // Between the given places the chord leaves the surface a little.
  for (const Vec3d& place : found) EXPECT_LE(to_polyline(place, line), tolerance + 0.002);
  for (const Vec3d& end : {line.front(), line.back()}) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3d& place : found) least = std::min(least, (place - end).norm());
    EXPECT_LE(least, tolerance + 0.002);
  }
}

/// Limits of values and speeds at many times between those of the trajectory.
void expect_limits_kept(const PlanTool& tool, const RobotTrajectory& trajectory) {
  const auto motion = RobotMotion::create(tool.robot, trajectory);
  ASSERT_TRUE(motion) << motion.error().text();
  EXPECT_TRUE(motion->excesses().empty());
  std::vector<double> values(tool.robot.values.size()), before;
  constexpr int kTimes = 5000;
  const double step = motion->last_time() / kTimes;
  for (int i = 0; i <= kTimes; ++i) {
    ASSERT_TRUE(motion->values_at(i * step, values));
    EXPECT_TRUE(check_limits(tool.robot, values));
    for (std::size_t v = 0; v < values.size() && i > 0; ++v) {
      const double limit = tool.robot.joints[tool.robot.values[v].joint].velocity;
      if (limit > 0) {
        EXPECT_LE(std::abs(values[v] - before[v]) / step, limit * (1 + 1e-6));
      }
    }
    before = values;
  }
}

TEST(PlanMotion, a_hand_tears_random_curves_on_a_character_that_moves) {
  const PlanTiming timing = while_it_bends();
  test::Random random(7);
  int planned_count = 0;
  for (int i = 0; i < 8; ++i) {
    WoundTarget target;
    target.places = test::random_curve(tube(), *make_pose(*tube(), timing.pose), 0.35, random);
    if (target.places.size() < 2) continue;
    target.depth = {0.02};
    const auto hand = free_hand(tube(), target, timing, 0.1);
    ASSERT_TRUE(hand) << hand.error().text();
    const auto planned = plan_motion(tube(), target, timing, *hand);
    ASSERT_TRUE(planned) << planned.error().text();
    const PlanReport& report = planned->report;
    ASSERT_TRUE(report.is_reachable);
    ++planned_count;
    EXPECT_LE(report.hausdorff, report.tolerance);
    EXPECT_LE(report.mean_distance, report.hausdorff);
    EXPECT_GE(report.hausdorff_in_clips, report.hausdorff);
    EXPECT_LE(report.most_place_error, report.tolerance);
    expect_torn_along(tube(), planned->tear, target, pose_at(*tube(), timing, report.cut_begins),
                      report.tolerance);
  }
  EXPECT_GE(planned_count, 5);
}

TEST(PlanMotion, an_arm_of_six_axes_keeps_its_limits) {
  const PlanTiming timing = while_it_bends();
  const WoundTarget target = front_curve(timing);
  const PlanTool tool = test::six_axis_arm(Vec3d(0.2, 0.2, 1.0));
  const auto planned = plan_motion(tube(), target, timing, tool);
  ASSERT_TRUE(planned) << planned.error().text();
  const PlanReport& report = planned->report;
  ASSERT_TRUE(report.is_reachable);
  EXPECT_LE(report.hausdorff, report.tolerance);
  EXPECT_LE(report.most_depth_error, 0.1 * target.depth[0]);
  expect_limits_kept(tool, planned->trajectory);
  ASSERT_EQ(report.values.size(), 6u);
  for (const ValueMargin& margin : report.values) {
    EXPECT_GE(margin.to_limits, 0);
    EXPECT_LE(margin.greatest_speed, margin.speed_limit);
  }
  expect_torn_along(tube(), planned->tear, target, pose_at(*tube(), timing, report.cut_begins),
                    report.tolerance);
  const auto again = plan_motion(tube(), target, timing, tool);
  EXPECT_EQ(again->trajectory.values, planned->trajectory.values);  // bit for bit
  EXPECT_EQ(again->tear.stroke, planned->tear.stroke);
}

TEST(PlanMotion, depth_and_angle_follow_their_profiles) {
  PlanTiming timing;
  timing.pose = ClipPose{"Bend", 0.2};
  WoundTarget target = front_curve(timing);
  target.depth.clear();
  target.angle.clear();
  for (std::size_t i = 0; i < target.places.size(); ++i) {
    target.depth.push_back(0.01 + 0.001 * static_cast<double>(i));
    target.angle.push_back(1.0 + 0.05 * static_cast<double>(i));
  }
  const auto hand = free_hand(tube(), target, timing, 0.1);
  ASSERT_TRUE(hand);
  const auto planned = plan_motion(tube(), target, timing, *hand);
  ASSERT_TRUE(planned) << planned.error().text();
  ASSERT_TRUE(planned->report.is_reachable);
  EXPECT_LE(planned->report.hausdorff, planned->report.tolerance);
  EXPECT_LE(planned->report.mean_depth_error, 0.001);
  EXPECT_LE(planned->report.mean_angle_error, 0.06);
  // In the middle of the cut, measured from the blade: the speed there is even.
  const auto motion = RobotMotion::create(hand->robot, planned->trajectory);
  std::vector<Affine3d> frames(hand->robot.links.size());
  const double middle = 0.5 * (planned->report.cut_begins + planned->report.cut_ends);
  ASSERT_TRUE(motion->pose_at(middle, frames, hand->world_from_root));
  const Vec3d base = frames[6] * hand->blade.base, tip = frames[6] * hand->blade.tip;
  const auto model = TornModel::create(tube());
  auto query = SurfaceQuery::create(*model);
  ASSERT_TRUE(query->set_pose(*make_pose(*tube(), timing.pose)));
  std::vector<SurfaceContact> contacts;
  ASSERT_TRUE(query->find_blade_contacts({base, tip}, contacts));
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts[0].depth, 0.016, 0.003);
  const double up = (base - tip).normalized().dot(contacts[0].normal);
  EXPECT_NEAR(std::asin(std::clamp(up, -1.0, 1.0)), 1.3, 0.2);
}

TEST(PlanMotion, closed_curves_and_curves_that_cross_themselves_and_a_seam) {
  PlanTiming timing;
  timing.pose = ClipPose{"Bend", 0.2};
  const ModelPose pose = *make_pose(*tube(), timing.pose);
  const Vec3d middle(0, 0.7, 0.3);
  for (const bool is_eight : {false, true}) {
    std::vector<Vec3d> near;
    for (int i = 0; i < 24; ++i) {
      const double angle = 2 * std::numbers::pi * i / 24;
      near.push_back(
          middle + Vec3d(0.08 * std::sin(is_eight ? 2 * angle : angle), 0.08 * std::cos(angle), 0));
    }
    WoundTarget target;
    target.places = test::nearest_places(tube(), pose, near);
    target.is_closed = true;
    target.depth = {0.02};
    const auto hand = free_hand(tube(), target, timing, 0.1);
    ASSERT_TRUE(hand) << hand.error().text();
    const auto planned = plan_motion(tube(), target, timing, *hand);
    ASSERT_TRUE(planned) << planned.error().text();
    ASSERT_TRUE(planned->report.is_reachable);
    EXPECT_LE(planned->report.hausdorff, planned->report.tolerance) << is_eight;
  }
}

TEST(PlanMotion, a_slow_joint_is_named_and_the_cut_may_take_longer) {
  PlanTiming timing = while_it_bends();
  const WoundTarget target = front_curve(timing);
  PlanTool tool = test::six_axis_arm(Vec3d(0.2, 0.2, 1.0));
  for (RobotJoint& joint : tool.robot.joints) joint.velocity = 0.25;
  const auto hurried = plan_motion(tube(), target, timing, tool);
  ASSERT_TRUE(hurried) << hurried.error().text();
  EXPECT_FALSE(hurried->report.is_reachable);
  ASSERT_FALSE(hurried->report.obstacles.empty());
  EXPECT_EQ(hurried->report.obstacles[0].kind, PlanObstacle::Kind::joint_speed);
  EXPECT_TRUE(hurried->tear.stroke.empty());
  timing.may_take_longer = true;
  timing.clip_speed = 0;
  const auto patient = plan_motion(tube(), target, timing, tool);
  ASSERT_TRUE(patient) << patient.error().text();
  EXPECT_TRUE(patient->report.is_reachable);
  EXPECT_GT(patient->report.cut, timing.cut);
  EXPECT_LE(patient->report.hausdorff, patient->report.tolerance);
  expect_limits_kept(tool, patient->trajectory);
}

TEST(PlanMotion, approach_and_retreat_grow_by_as_much_as_the_cut) {
  PlanTiming timing = while_it_bends();
  timing.clip_speed = 0;
  timing.may_take_longer = true;
  PlanTool tool = test::six_axis_arm(Vec3d(0.2, 0.2, 1.0));
  for (RobotJoint& joint : tool.robot.joints) joint.velocity = 0.002;
  const auto planned = plan_motion(tube(), front_curve(timing), timing, tool);
  ASSERT_TRUE(planned) << planned.error().text();
  const PlanReport& report = planned->report;
  EXPECT_FALSE(report.is_reachable);
  EXPECT_DOUBLE_EQ(report.cut, 16 * timing.cut);
  EXPECT_DOUBLE_EQ(report.cut_begins, 16 * timing.approach);
}

TEST(PlanMotion, a_short_cut_after_a_long_approach_is_made_and_measured) {
  PlanTiming timing = while_it_bends();
  timing.clip_speed = 0;
  timing.approach = 20;
  timing.cut = 0.05;
  timing.retreat = 31;
  const WoundTarget target = front_curve(timing);
  PlanTool tool = test::six_axis_arm(Vec3d(0.2, 0.2, 1.0));
  const auto hurried = plan_motion(tube(), target, timing, tool);
  ASSERT_TRUE(hurried) << hurried.error().text();
  EXPECT_FALSE(hurried->report.is_reachable);
  ASSERT_FALSE(hurried->report.obstacles.empty());
  EXPECT_EQ(hurried->report.obstacles[0].kind, PlanObstacle::Kind::joint_speed);
  for (RobotJoint& joint : tool.robot.joints) joint.velocity = 0;  // no limit
  const auto planned = plan_motion(tube(), target, timing, tool);
  ASSERT_TRUE(planned) << planned.error().text();
  const PlanReport& report = planned->report;
  ASSERT_TRUE(report.is_reachable);
  EXPECT_LE(report.hausdorff, report.tolerance);
  EXPECT_LE(report.most_depth_error, 0.1 * target.depth[0]);
  EXPECT_TRUE(std::isfinite(report.mean_depth_error));
  EXPECT_TRUE(std::isfinite(report.mean_angle_error));
  expect_torn_along(tube(), planned->tear, target, *make_pose(*tube(), timing.pose),
                    report.tolerance);
}

TEST(PlanMotion, a_limit_that_stops_the_blade_is_named_and_without_it_the_curve_is_made) {
  PlanTiming timing;
  timing.pose = BindPose{};
  // The sheet in the unit square stands 0.9 m before an arm of two joints.
  const auto sheet = std::make_shared<const Character>(test::make_sheet(20));
  PlanTool tool;
  tool.robot = test::make_planar_arm();
  tool.blade = test::blade_across();
  tool.world_from_root.translation() = Vec3d(0.5, -0.9, 0);
  WoundTarget target;
  const ModelPose pose = *make_pose(*sheet, timing.pose);
  target.places = test::nearest_places(
      sheet, pose, {Vec3d(0.3, 0.5, 0), Vec3d(0.5, 0.3, 0), Vec3d(0.7, 0.2, 0)});
  target.depth = {0.1};
  // 0.25 rad of the elbow are a curve that only its ends lack.
  tool.robot.joints[1].lower = tool.robot.values[1].lower = -1.75;
  tool.robot.joints[1].upper = tool.robot.values[1].upper = 1.75;
  const auto stopped = plan_motion(sheet, target, timing, tool);
  ASSERT_TRUE(stopped) << stopped.error().text();
  const PlanReport& report = stopped->report;
  ASSERT_FALSE(report.is_reachable);
  ASSERT_EQ(report.obstacles.size(), 1u);
  EXPECT_EQ(report.obstacles[0].kind, PlanObstacle::Kind::joint_limit);
  EXPECT_EQ(report.obstacles[0].value, "elbow");
  EXPECT_LT(report.first_share, report.last_share);
  EXPECT_LT(report.last_share, 1);
  EXPECT_TRUE(stopped->trajectory.times.empty());
  tool.robot.joints[1].lower = tool.robot.values[1].lower = -3.1;
  tool.robot.joints[1].upper = tool.robot.values[1].upper = 3.1;
  const auto free = plan_motion(sheet, target, timing, tool);
  ASSERT_TRUE(free) << free.error().text();
  EXPECT_TRUE(free->report.is_reachable);
  EXPECT_LE(free->report.hausdorff, free->report.tolerance);
  // Farther away than the arm is long.
  tool.world_from_root.translation() = Vec3d(0.5, -4, 0);
  const auto far = plan_motion(sheet, target, timing, tool);
  ASSERT_TRUE(far) << far.error().text();
  EXPECT_FALSE(far->report.is_reachable);
  ASSERT_EQ(far->report.obstacles.size(), 1u);
  EXPECT_EQ(far->report.obstacles[0].kind, PlanObstacle::Kind::reach);
  EXPECT_EQ(far->report.last_share, 0);
}

/// The arm of docs/plan.md's picture: a ball around the wrist and capsules along the arm.
PlanTool arm_with_shapes() {
  PlanTool tool = test::six_axis_arm(Vec3d(0.2, 0.2, 1.0));
  const auto capsule = [&](std::uint32_t link, double radius, double from, double to) {
    tool.shapes.push_back(
        {link, {Collider::Capsule{radius, 0.5 * (to - from)}, Vec3d(0, 0.5 * (from + to), 0)}});
  };
  capsule(2, 0.05, 0, 0.5);
  capsule(3, 0.04, 0, 0.4);
  capsule(5, 0.03, 0, 0.05);
  return tool;
}

/// Whether the middle line of a capsule comes nearer to the vertices than its radius, at many
/// times: from positions of the tests' reference.
double least_distance(const PlanTool& tool, const RobotTrajectory& trajectory,
                      const PlanTiming& timing) {
  const auto motion = RobotMotion::create(tool.robot, trajectory);
  std::vector<Affine3d> frames(tool.robot.links.size());
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 100; ++i) {
    const double time = motion->last_time() * i / 100;
    EXPECT_TRUE(motion->pose_at(time, frames, tool.world_from_root));
    const ModelPose pose = pose_at(*tube(), timing, time);
    const std::vector<Vec3d> posed = test::posed_positions(*tube(), 0, pose);
    for (const BoneCollider& shape : tool.shapes) {
      const auto& capsule = std::get<Collider::Capsule>(shape.collider.shape);
      const Vec3d half(0, capsule.half_length, 0);
      const std::vector<Vec3d> line = {frames[shape.bone] * Vec3d(shape.collider.place - half),
                                       frames[shape.bone] * Vec3d(shape.collider.place + half)};
      for (const Vec3d& vertex : posed)
        least = std::min(least, to_polyline(vertex, line) - capsule.radius);
    }
  }
  return least;
}

TEST(PlanMotion, links_stay_outside_of_the_character) {
  const PlanTiming timing = while_it_bends();
  const WoundTarget target = front_curve(timing);
  const PlanTool tool = arm_with_shapes();
  const auto planned = plan_motion(tube(), target, timing, tool);
  ASSERT_TRUE(planned) << planned.error().text();
  ASSERT_TRUE(planned->report.is_reachable);
  EXPECT_GT(planned->report.least_clearance, 0);
  EXPECT_LE(planned->report.hausdorff, planned->report.tolerance);
  // The tube's vertices are as dense as the places that plans look at.
  EXPECT_GT(least_distance(tool, planned->trajectory, timing), -0.002);
}

TEST(PlanMotion, a_link_that_cannot_stay_outside_is_named) {
  const PlanTiming timing = while_it_bends();
  PlanTool tool = arm_with_shapes();
  std::get<Collider::Capsule>(tool.shapes[2].collider.shape).radius = 0.2;  // wider than the blade
  const auto planned = plan_motion(tube(), front_curve(timing), timing, tool);
  ASSERT_TRUE(planned) << planned.error().text();
  ASSERT_FALSE(planned->report.is_reachable);
  ASSERT_FALSE(planned->report.obstacles.empty());
  EXPECT_EQ(planned->report.obstacles[0].kind, PlanObstacle::Kind::collision);
  EXPECT_EQ(planned->report.obstacles[0].value, "bend");
  tool.shapes.pop_back();
  const auto without = plan_motion(tube(), front_curve(timing), timing, tool);
  EXPECT_TRUE(without->report.is_reachable);
}

TEST(PlanMotion, a_tear_that_meets_another_part_is_no_plan) {
  // Two sheets, one 3 cm above the other: the blade to the lower one passes the upper one.
  Character both = test::make_sheet(12);
  Mesh above = both.meshes[0];
  above.name = "above";
  for (Vec3f& place : above.positions) place.z() += 0.03f;
  both.meshes.push_back(above);
  const auto character = std::make_shared<const Character>(std::move(both));
  PlanTiming timing;
  timing.pose = BindPose{};
  WoundTarget target;
  target.places = test::nearest_places(character, *make_pose(*character, timing.pose),
                                       {Vec3d(0.3, 0.4, -1), Vec3d(0.7, 0.5, -1)});
  ASSERT_EQ(target.places[0].mesh, 0u);
  const auto hand = free_hand(character, target, timing, 0.1);
  ASSERT_TRUE(hand);
  const auto planned = plan_motion(character, target, timing, *hand);
  ASSERT_TRUE(planned) << planned.error().text();
  EXPECT_FALSE(planned->report.is_reachable);
  ASSERT_EQ(planned->report.obstacles.size(), 1u);
  EXPECT_EQ(planned->report.obstacles[0].kind, PlanObstacle::Kind::wound);
  EXPECT_FALSE(planned->trajectory.times.empty());
  target.places = test::nearest_places(character, *make_pose(*character, timing.pose),
                                       {Vec3d(0.3, 0.4, 1), Vec3d(0.7, 0.5, 1)});
  const auto upper = plan_motion(character, target, timing, *hand);
  EXPECT_TRUE(upper->report.is_reachable);
}

class PlanRefusals : public testing::Test {
 protected:
  void refused(StatusCode code, const char* text) {
    const auto planned = plan_motion(tube(), target, timing, tool, options);
    ASSERT_FALSE(planned);
    EXPECT_EQ(planned.error().code(), code) << planned.error().text();
    EXPECT_THAT(planned.error().text(), HasSubstr(text));
  }
  PlanTiming timing = while_it_bends();
  WoundTarget target = front_curve(timing);
  PlanTool tool = test::six_axis_arm(Vec3d(0.2, 0.2, 1.0));
  PlanOptions options;
};

TEST_F(PlanRefusals, of_curves_name_the_place) {
  const WoundTarget good = target;
  target.places.resize(1);
  refused(StatusCode::empty_input, "1 places");
  target.places = {good.places[0], good.places[0]};
  refused(StatusCode::empty_input, "no length");
  target = good;
  target.places[3].birth.triangle = 1 << 20;
  refused(StatusCode::index_out_of_range, "place 3: triangle 1048576");
  target = good;
  target.places[2].mesh = 7;
  refused(StatusCode::index_out_of_range, "place 2: mesh 7");
  target = good;
  target.places[1].birth.barycentric[0] = std::nan("");
  refused(StatusCode::non_finite_value, "place 1");
  target.places[1].birth.barycentric = {0.5, 0.7, 0.1};
  refused(StatusCode::invalid_argument, "sum 1.3");
  target = good;
  target.depth = {0.02, 0};
  refused(StatusCode::size_mismatch, "depth has 2 numbers");
  target.depth = {0};
  refused(StatusCode::invalid_argument, "depth 0 is 0");
  target.depth = {0.2};
  refused(StatusCode::invalid_argument, "cannot reach 0.2 m");
  target = good;
  target.angle = {4};
  refused(StatusCode::invalid_argument, "angle 0 is 4");
}

TEST_F(PlanRefusals, of_curves_between_surfaces_that_are_apart) {
  const auto two = std::make_shared<const Character>(test::make_two_tubes(12, 12));
  const ModelPose pose = *make_pose(*two, BindPose{});
  double height = 0;
  for (const Mesh& mesh : two->meshes)
    for (const Vec3d& place : test::posed_positions(*two, mesh.skin, pose))
      height = std::max(height, place.y());
  // A chord through the inside of the tubes, from the bottom to the top.
  target.places = test::nearest_places(two, pose, {Vec3d(0, -1, 0), Vec3d(0, height + 1, 0)});
  timing.pose = BindPose{};
  timing.clip_speed = 0;
  const auto planned = plan_motion(two, target, timing, tool, options);
  ASSERT_FALSE(planned);
  EXPECT_EQ(planned.error().code(), StatusCode::invalid_argument);
  EXPECT_THAT(planned.error().text(), HasSubstr("places 0 and 1"));
}

TEST_F(PlanRefusals, of_tools_and_times) {
  const PlanTool good = tool;
  tool.blade.link = 9;
  refused(StatusCode::index_out_of_range, "link 9");
  tool.blade.link = 0;
  refused(StatusCode::invalid_argument, "no joint moves link 'base'");
  tool = good;
  tool.blade.tip = tool.blade.base;
  refused(StatusCode::invalid_argument, "one place");
  tool = good;
  tool.world_from_root.translation().x() = std::nan("");
  refused(StatusCode::non_finite_value, "place of the robot");
  tool = good;
  timing.cut = 0;
  refused(StatusCode::invalid_argument, "the cut takes 0 s");
  timing = while_it_bends();
  timing.pose = BindPose{};
  refused(StatusCode::invalid_argument, "none of a clip");
  timing.pose = ClipPose{"Jump", 0};
  refused(StatusCode::not_found, "Jump");
  timing = while_it_bends();
  options.tolerance = -1;
  refused(StatusCode::invalid_argument, "tolerance");
  options = {};
  options.clearance = -1;
  refused(StatusCode::invalid_argument, "clearance");
  options = {};
  tool.shapes.push_back({40, {Collider::Sphere{1}}});
  refused(StatusCode::index_out_of_range, "shape 0: link 40");
}

}  // namespace
}  // namespace sunder
