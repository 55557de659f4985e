// SUNDER_W_POP: how far an operation moves the posed surface at its moment.

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>
#include <sunder/validation/validation.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/rigs.h"
#include "validation/shared_character.h"

namespace sunder::test {
namespace {

using testing::HasSubstr;
/// A tube of few faces, so that new vertices leave the surface when bones twist.
Shared coarse_tube() {
  Character tube = make_tube(6, 10, 3);
  tube.clips.clear();
  return std::make_shared<const Character>(std::move(tube));
}

ModelPose twisted(const Character& character, float angle) {
  Pose pose = *local_rest_pose(character);
  for (std::size_t bone = 1; bone < pose.parent_from_bone.size(); ++bone)
    pose.parent_from_bone[bone].rotation =
        Quatf(Eigen::AngleAxisf(angle, Eigen::Vector3f(0.2f, 1.0f, 0.3f).normalized()));
  ModelPose result;
  EXPECT_TRUE(compute_model_pose(character.skeleton, pose, result));
  return result;
}

/// A stroke along the front of the posed tube, from low to high, in so many segments.
TearOperation tear_up(const ModelPose& pose, WeightPolicy policy, double x = 0.05,
                      std::uint32_t segments = 4) {
  TearOperation tear;
  tear.pose = pose;
  for (std::uint32_t i = 0; i <= segments; ++i) {
    const double y = 0.35 + 2.2 * i / segments;
    tear.stroke.push_back({Vec3d(x, y, 2.0), Vec3d(x, y, 0.1)});
  }
  tear.options.weights = WeightOptions{policy, 0};
  return tear;
}

ValidationReport validate(const Shared& source, const TornModel& torn,
                          const std::vector<Operation>& operations) {
  ValidationOptions options;
  options.operations = operations;
  const auto report =
      validate_skin(source, std::make_shared<const Character>(torn.character()), options);
  EXPECT_TRUE(report) << report.error().text();
  return report ? *report : ValidationReport{};
}

const Finding* pop_of(const ValidationReport& report) {
  const auto found =
      std::ranges::find(report.findings, std::string_view("SUNDER_W_POP"), &Finding::code);
  return found == report.findings.end() ? nullptr : &*found;
}

TornModel play(const Shared& source, const std::vector<Operation>& operations) {
  auto torn = TornModel::create(source);
  for (const Operation& operation : operations) {
    const auto report = apply_operation(*torn, operation);
    EXPECT_TRUE(report) << report.error().text();
    if (report && operation.index() < 3) {
      EXPECT_GT(report->runs, 0u);
    }
  }
  return std::move(*torn);
}

/// The largest distance between a new vertex and the blend of the corners it was born between.
double largest_from_parents(const TornModel& torn, const ModelPose& pose) {
  double largest = 0.0;
  const Mesh& source = torn.source().meshes[0];
  const auto before = posed_positions(torn.source(), 0, pose),
             after = posed_positions(torn.character(), 0, pose);
  for (Index v = source.vertex_count(); v < after.size(); ++v) {
    const Birth birth = torn.birth(0, v);
    if (birth.triangle >= source.triangle_count()) continue;
    Vec3d place = Vec3d::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      place += birth.barycentric[k] * before[source.triangles[birth.triangle][k]];
    largest = std::max(largest, (after[v] - place).norm());
  }
  return largest;
}

TEST(Pop, of_a_first_tear_is_the_distance_from_the_parents_blend) {
  const Shared source = coarse_tube();
  const ModelPose pose = twisted(*source, 0.9f);
  const std::vector<Operation> operations = {tear_up(pose, WeightPolicy::barycentric)};
  const TornModel torn = play(source, operations);
  const ValidationReport report = validate(source, torn, operations);
  const Finding* const pop = pop_of(report);
  ASSERT_NE(pop, nullptr);
  const double expected = largest_from_parents(torn, pose);
  ASSERT_GT(expected, 2e-3 * report.diagonal);
  EXPECT_NEAR(pop->value, expected, 1e-6 * expected);
  EXPECT_EQ(pop->count, 1u);
  EXPECT_THAT(pop->text, HasSubstr("operation 0 (tear)"));
  ASSERT_EQ(pop->places.size(), 1u);
  EXPECT_GE(pop->places[0].vertex, source->meshes[0].vertex_count());
}

TEST(Pop, is_none_where_weights_are_exact_in_the_pose_or_the_pose_is_bind) {
  const Shared source = coarse_tube();
  const ModelPose pose = twisted(*source, 0.9f);
  for (const WeightPolicy policy : {WeightPolicy::pose_exact, WeightPolicy::exact}) {
    const std::vector<Operation> operations = {tear_up(pose, policy)};
    EXPECT_EQ(pop_of(validate(source, play(source, operations), operations)), nullptr);
  }
  const std::vector<Operation> at_bind = {tear_up(*bind_pose(*source), WeightPolicy::barycentric)};
  EXPECT_EQ(pop_of(validate(source, play(source, at_bind), at_bind)), nullptr);
}

TEST(Pop, does_not_count_surface_that_an_operation_makes_or_removes) {
  const Shared source = coarse_tube();
  const ModelPose pose = twisted(*source, 0.9f);
  TearOperation gap = tear_up(pose, WeightPolicy::pose_exact);
  gap.options.width = 0.08;
  gap.options.wall_depth = 0.2;
  CutOperation cut;
  cut.pose = pose;
  cut.cut = {Vec3d(0, 1.7, 0),
             Vec3d(0.2, 1.0, 0.1),
             {},
             true,
             {},
             WeightOptions{WeightPolicy::pose_exact, 0}};
  DrillOperation drill;
  drill.pose = pose;
  drill.bore.origin = Vec3d(0.1, 0.8, -2.0);
  drill.bore.direction = Vec3d(0, 0, 1);
  drill.bore.radius = 0.15;
  drill.bore.depth = 5.0;
  drill.bore.wall = true;
  drill.bore.weights = WeightOptions{WeightPolicy::pose_exact, 0};
  for (const Operation& operation : std::vector<Operation>{gap, cut, drill}) {
    const std::vector<Operation> operations = {operation};
    const ValidationReport report = validate(source, play(source, operations), operations);
    const Finding* const pop = pop_of(report);
    EXPECT_EQ(pop, nullptr) << operation.index() << ": " << pop->text;
  }
}

TEST(Pop, of_a_tear_whose_pose_changes_is_measured_blade_by_blade) {
  const Shared source = coarse_tube();
  const ModelPose first = twisted(*source, 0.3f), second = twisted(*source, 0.9f);
  TearOperation tear = tear_up(first, WeightPolicy::pose_exact);
  tear.pose_changes.push_back({3, second});
  // Each blade is exact in its own pose, although not in the other one.
  const std::vector<Operation> exact = {tear};
  const TornModel torn = play(source, exact);
  ASSERT_GT(largest_from_parents(torn, second), 0.005);
  EXPECT_EQ(pop_of(validate(source, torn, exact)), nullptr);
  // Without exact weights the larger twist is found, although the tear begins in the smaller one.
  tear.options.weights = WeightOptions{WeightPolicy::barycentric, 0};
  tear.pose = *bind_pose(*source);
  const std::vector<Operation> interpolated = {tear};
  const ValidationReport report = validate(source, play(source, interpolated), interpolated);
  EXPECT_NE(pop_of(report), nullptr);
}

TEST(Pop, of_a_second_tear_is_measured_against_the_surface_that_the_first_one_left) {
  const Shared source = coarse_tube();
  const ModelPose pose = twisted(*source, 0.9f);
  // Torn in bind with interpolated weights, then cut across in the pose with exact ones: the new
  // points of the cut are on the untorn surface, not on the one that was there.
  CutOperation across;
  across.pose = pose;
  across.cut = {
      Vec3d(0, 1.45, 0), Vec3d(0, 1, 0), {}, false, {}, WeightOptions{WeightPolicy::pose_exact, 0}};
  const std::vector<Operation> operations = {
      tear_up(*bind_pose(*source), WeightPolicy::barycentric), across};
  const std::vector<Operation> alone = {across};
  EXPECT_EQ(pop_of(validate(source, play(source, alone), alone)), nullptr);
  const ValidationReport report = validate(source, play(source, operations), operations);
  const Finding* const pop = pop_of(report);
  ASSERT_NE(pop, nullptr);
  EXPECT_EQ(pop->count, 1u);
  EXPECT_THAT(pop->text, HasSubstr("operation 1 (cut)"));
}

TEST(Pop, of_new_weights_is_how_far_they_move_vertices) {
  const Shared source = coarse_tube();
  const ModelPose pose = twisted(*source, 0.9f);
  const TearOperation tear = tear_up(*bind_pose(*source), WeightPolicy::barycentric);
  WeightsOperation weights;
  weights.weights = WeightOptions{WeightPolicy::pose_exact, 0};
  weights.pose = pose;
  const TornModel before = play(source, {tear});
  const double expected = largest_from_parents(before, pose);
  const std::vector<Operation> operations = {tear, weights};
  const ValidationReport report = validate(source, play(source, operations), operations);
  const Finding* const pop = pop_of(report);
  ASSERT_NE(pop, nullptr);
  EXPECT_NEAR(pop->value, expected, 1e-5);
  EXPECT_THAT(pop->text, HasSubstr("operation 1 (weights)"));
}

TEST(Pop, names_no_vertex_that_the_target_does_not_have) {
  const Shared source = coarse_tube();
  const std::vector<Operation> operations = {
      tear_up(twisted(*source, 0.9f), WeightPolicy::barycentric)};
  ValidationOptions options;
  options.operations = operations;
  const auto report = validate_skin(source, source, options);
  ASSERT_TRUE(report) << report.error().text();
  const Finding* const pop = pop_of(*report);
  ASSERT_NE(pop, nullptr);
  ASSERT_EQ(pop->places.size(), 1u);
  EXPECT_EQ(pop->places[0].vertex, kNone);
}

}  // namespace
}  // namespace sunder::test
