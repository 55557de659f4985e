// A planar arm tears a flat sheet: the tear lies where the blade passed.

#include <sunder/robot/trajectory.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "robot/planar_arm.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::blade_across;
using test::make_planar_arm;

/// By how much a tear may leave its stroke sideways, metres: it snaps to edges and vertices that
/// are nearer than a thousandth of an edge, here 0.05 m.
constexpr double kSnap = 1e-4;
/// How much of the stroke's ends may be missing: they snap too, or end with the last whole step.
constexpr double kStep = 0.002;

/// The sheet in the unit square stands 0.9 m before the arm.
Affine3d arm_place() {
  Affine3d world_from_root = Affine3d::Identity();
  world_from_root.translation() = Vec3d(0.5, -0.9, 0);
  return world_from_root;
}

BladeSweep sweep(const RobotTrajectory& trajectory, double spacing = 0.002) {
  const auto motion = RobotMotion::create(make_planar_arm(), trajectory);
  EXPECT_TRUE(motion) << motion.error().text();
  SweepOptions options;
  options.spacing = spacing;
  auto found = sweep_blade(*motion, blade_across(), arm_place(), options);
  EXPECT_TRUE(found) << found.error().text();
  return found ? std::move(*found) : BladeSweep();
}

struct Torn {
  TornModel model;
  TearReport report;
};

Torn torn_by(const BladeSweep& found) {
  auto model = TornModel::create(std::make_shared<const Character>(test::make_sheet(20)));
  EXPECT_TRUE(model);
  const auto tear = tear_of_sweep(found);
  EXPECT_TRUE(tear) << tear.error().text();
  auto report = apply_operation(*model, *tear);
  EXPECT_TRUE(report) << report.error().text();
  return {std::move(*model), report ? *report : TearReport()};
}

/// The places of the vertices that a tear added.
std::vector<Vec2d> new_places(const TornModel& model) {
  std::vector<Vec2d> places;
  const Mesh& mesh = model.character().meshes[0];
  for (Index v = model.source().meshes[0].vertex_count(); v < mesh.vertex_count(); ++v)
    places.emplace_back(mesh.positions[v].x(), mesh.positions[v].y());
  return places;
}

TEST(RobotTears, a_straight_line_where_the_end_of_the_arm_passed) {
  // In the arm's frame from (-0.2, 1.4) to (0.2, 1.1): in the sheet's from (0.3, 0.5) to (0.7,
  // 0.2).
  const Torn torn = torn_by(sweep(test::line({-0.2, 1.4}, {0.2, 1.1}, 200)));
  EXPECT_EQ(torn.report.runs, 1u);
  EXPECT_EQ(torn.report.segments_missed, 0u);
  const std::vector<Vec2d> places = new_places(torn.model);
  ASSERT_GT(places.size(), 20u);
  const Vec2d from(0.3, 0.5), along = Vec2d(0.4, -0.3) / 0.5;
  double least = 1, most = 0;
  for (const Vec2d& place : places) {
    const Vec2d offset = place - from;
    const double s = offset.dot(along);
    EXPECT_LE((offset - s * along).norm(), kSnap);
    least = std::min(least, s);
    most = std::max(most, s);
  }
  EXPECT_NEAR(least, 0, kStep);
  EXPECT_NEAR(most, 0.5, kStep);
  EXPECT_NEAR(torn.report.length_posed, 0.5, 2 * kStep);
}

TEST(RobotTears, an_arc_within_the_tolerance_of_the_sampling) {
  // The straight arm turns about (0.5, -0.9): the end is 2 m away; bent by 1.5 it is nearer.
  const double radius = 2 * std::cos(0.75);
  const RobotTrajectory arc = {{"shoulder", "elbow"}, {0, 1}, {0.65, 1.5, 1.0, 1.5}};
  double length = 0;
  for (const double spacing : {0.02, 0.005, 0.001}) {
    const Torn torn = torn_by(sweep(arc, spacing));
    EXPECT_EQ(torn.report.runs, 1u);
    for (const Vec2d& place : new_places(torn.model))
      EXPECT_NEAR((place - Vec2d(0.5, -0.9)).norm(), radius,
                  spacing * spacing / (8 * radius) + kSnap);
    if (length > 0) {
      EXPECT_NEAR(torn.report.length_posed, length, 2 * kStep);
    }
    length = torn.report.length_posed;
  }
  EXPECT_NEAR(length, 0.35 * radius, 2 * kStep);
}

TEST(RobotTears, a_blade_beside_the_sheet_misses_and_changes_nothing) {
  const BladeSweep beside = sweep(test::line({0.7, 1.4}, {0.9, 1.1}, 20));
  auto model = TornModel::create(std::make_shared<const Character>(test::make_sheet(8)));
  ASSERT_TRUE(model);
  const std::uint64_t before = model->digest();
  const auto report = apply_operation(*model, *tear_of_sweep(beside));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->runs, 0u);
  EXPECT_EQ(report->segments_missed, beside.blades.size() - 1);
  EXPECT_EQ(model->digest(), before);
  // A sweep in a pose that does not exist changes nothing either.
  const BladeSweep across = sweep(test::line({-0.2, 1.4}, {0.2, 1.1}, 20));
  EXPECT_FALSE(apply_operation(*model, *tear_of_sweep(across, ClipPose{"Walk", 0}, 1.0)));
  EXPECT_EQ(model->digest(), before);
}

TEST(RobotTears, a_character_in_the_middle_of_its_animation) {
  // A tube that bends while the blade passes across it: the lips lie where the blade met the moving
  // surface, which the same stroke drawn blade by blade says too.
  const auto tube = std::make_shared<const Character>(test::make_tube(24, 16, 3));
  const auto motion =
      RobotMotion::create(make_planar_arm(), test::line({-0.3, 1.5}, {0.3, 1.5}, 50));
  ASSERT_TRUE(motion);
  Affine3d place = Affine3d::Identity();
  place.translation() = Vec3d(0, 0, 0.5);
  SweepOptions options;
  options.spacing = 0.02;
  options.seconds = 1.0 / 30;
  const auto found = sweep_blade(*motion, {2, {1, 0, 0.4}, {1, 0, -0.4}}, place, options);
  ASSERT_TRUE(found) << found.error().text();
  const auto tear = tear_of_sweep(*found, ClipPose{"Bend", 0.2}, 0.5);
  ASSERT_TRUE(tear);
  auto model = TornModel::create(tube);
  ASSERT_TRUE(model);
  const auto report = apply_operation(*model, *tear);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_GT(report->faces_crossed, 5u);
  // The log with all its poses gives the same model again.
  auto again = TornModel::create(tube);
  for (const Operation& operation : *model->history())
    ASSERT_TRUE(apply_operation(*again, operation));
  EXPECT_EQ(again->digest(), model->digest());
  ASSERT_TRUE(model->undo());
  EXPECT_EQ(model->digest(), TornModel::create(tube)->digest());
}

}  // namespace
}  // namespace sunder
