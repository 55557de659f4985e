#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::down_at;
using test::make_model;
using test::Random;
using testing::HasSubstr;
using testing::IsEmpty;

ModelPose rest(const Character& character) {
  ModelPose pose;
  EXPECT_TRUE(compute_model_pose(character.skeleton, *local_rest_pose(character), pose));
  return pose;
}

TEST(TornModel, tear_inside_the_sheet_opens_one_loop_of_the_strokes_length) {
  TornModel model = make_model(test::make_sheet(10));
  ChangeRecord change;
  const auto report = model.tear(
      rest(model.source()), std::vector{down_at(0.23, 0.31), down_at(0.61, 0.52)}, {}, &change);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->runs, 1u);
  EXPECT_NEAR(report->length_posed, std::hypot(0.38, 0.21), 1e-3);
  const TopologyCounts after = *count_topology(model.character());
  EXPECT_EQ(after.boundary_loops, 2u);
  EXPECT_EQ(after.components, 1u);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
  EXPECT_THAT(test::broken_lips(model, change), IsEmpty());
  EXPECT_FALSE(change.lips.empty());
}

TEST(TornModel, tear_across_the_whole_sheet_separates_it) {
  TornModel model = make_model(test::make_sheet(8));
  const auto report =
      model.tear(rest(model.source()),
                 std::vector{down_at(-0.2, 0.43), down_at(0.5, 0.47), down_at(1.2, 0.44)});
  ASSERT_TRUE(report);
  EXPECT_EQ(count_topology(model.character())->components, 2u);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
}

TEST(TornModel, tear_along_grid_lines_and_through_vertices_makes_no_sliver) {
  TornModel model = make_model(test::make_sheet(10));
  const auto report =
      model.tear(rest(model.source()), std::vector{down_at(-0.1, 0.5), down_at(1.1, 0.5)});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->triangles_added, 0u);
  EXPECT_EQ(report->points_added, 11u);
  EXPECT_EQ(count_topology(model.character())->components, 2u);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
}

TEST(TornModel, tear_within_one_face_opens) {
  TornModel model = make_model(test::make_sheet(1));
  const auto report =
      model.tear(rest(model.source()), std::vector{down_at(0.5, 0.1), down_at(0.8, 0.3)});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->runs, 1u);
  EXPECT_EQ(count_topology(model.character())->boundary_loops, 2u);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
}

TEST(TornModel, segments_continue_from_the_stored_tip) {
  TornModel model = make_model(test::make_sheet(7));
  Stroke stroke;
  for (int i = 0; i <= 20; ++i)
    stroke.push_back(down_at(0.2 + 0.03 * i, 0.5 + 0.2 * std::sin(0.5 * i)));
  ChangeRecord change;
  const auto report = model.tear(rest(model.source()), stroke, {}, &change);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->runs, 1u);
  const TopologyCounts after = *count_topology(model.character());
  EXPECT_EQ(after.boundary_loops, 2u) << "one slit";
  EXPECT_EQ(after.components, 1u);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
  EXPECT_THAT(test::broken_lips(model, change), IsEmpty());
}

TEST(TornModel, tear_that_crosses_an_older_one_leaves_no_bridge) {
  TornModel model = make_model(test::make_sheet(9));
  ASSERT_TRUE(
      model.tear(rest(model.source()), std::vector{down_at(-0.1, 0.4371), down_at(1.1, 0.5213)}));
  ASSERT_TRUE(
      model.tear(rest(model.source()), std::vector{down_at(0.4713, -0.1), down_at(0.5119, 1.1)}));
  EXPECT_EQ(count_topology(model.character())->components, 4u);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
}

TEST(TornModel, only_the_nearest_layer_within_reach_is_torn) {
  TornModel model = make_model(test::make_tube(12, 16, 3));
  // Through both walls: the blade is longer than the tube is wide.
  const Stroke stroke = {{{-0.2, 1.2, 2}, {-0.2, 1.2, -2}}, {{0.25, 1.7, 2}, {0.25, 1.7, -2}}};
  ASSERT_TRUE(model.tear(rest(model.source()), stroke));
  const Mesh& mesh = model.character().meshes[0];
  ASSERT_GT(mesh.vertex_count(), model.source().meshes[0].vertex_count());
  for (std::uint32_t v = model.source().meshes[0].vertex_count(); v < mesh.vertex_count(); ++v)
    EXPECT_GT(mesh.positions[v].z(), 0.0f);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
}

TEST(TornModel, a_stroke_beyond_the_blades_reach_changes_nothing) {
  TornModel model = make_model(test::make_sheet(4));
  ChangeRecord change;
  const Stroke stroke = {{{0.2, 0.2, 0.5}, {0.2, 0.2, 0.1}}, {{0.7, 0.2, 0.5}, {0.7, 0.2, 0.1}}};
  const auto report = model.tear(rest(model.source()), stroke, {}, &change);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->runs, 0u);
  EXPECT_EQ(report->segments_missed, 1u);
  EXPECT_TRUE(change.meshes.empty());
  EXPECT_EQ(model.character(), model.source());
}

TEST(TornModel, tear_runs_over_uv_seams_and_into_the_caps) {
  TornModel model = make_model(test::make_tube(10, 12, 3));
  // Along the seam side (+x), over the rim, onto the cap.
  const Stroke stroke = {{{0.9, 2.2, 0.03}, {0.3, 2.2, 0.03}},
                         {{0.9, 3.3, -0.05}, {0.1, 2.9, -0.05}},
                         {{0.2, 3.4, -0.07}, {0.1, 2.8, -0.07}}};
  ChangeRecord change;
  const auto report = model.tear(rest(model.source()), stroke, {}, &change);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(count_topology(model.character())->boundary_loops, 1u) << "one slit over side and cap";
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
  EXPECT_THAT(test::broken_lips(model, change), IsEmpty());
}

TEST(TornModel, refuses_bad_strokes_and_poses_and_stays_as_it_was) {
  TornModel model = make_model(test::make_sheet(4));
  const ModelPose pose = rest(model.source());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto code_of = [&](const ModelPose& at, const Stroke& stroke) {
    const auto report = model.tear(at, stroke);
    EXPECT_EQ(model.character(), model.source());
    return report ? StatusCode::ok : report.error().code();
  };
  EXPECT_EQ(code_of(pose, {}), StatusCode::invalid_argument);
  EXPECT_EQ(code_of(pose, {down_at(0.5, 0.5)}), StatusCode::invalid_argument);
  EXPECT_EQ(code_of(pose, {down_at(0.2, 0.5), {{nan, 0, 1}, {0, 0, 0}}}),
            StatusCode::non_finite_value);
  EXPECT_EQ(code_of(pose, {down_at(0.2, 0.5), {{0.4, 0.5, 0}, {0.4, 0.5, 0}}}),
            StatusCode::invalid_argument);
  EXPECT_EQ(code_of(pose, {down_at(0.2, 0.5), {{0.4, 0.5, -1}, {0.4, 0.5, 1}}}),
            StatusCode::invalid_argument);
  ModelPose short_pose = pose;
  short_pose.model_from_bone.pop_back();
  EXPECT_EQ(code_of(short_pose, {down_at(0.2, 0.5), down_at(0.6, 0.5)}), StatusCode::size_mismatch);
  ModelPose nan_pose = pose;
  nan_pose.model_from_bone[1].translation().x() = nan;
  EXPECT_EQ(code_of(nan_pose, {down_at(0.2, 0.5), down_at(0.6, 0.5)}),
            StatusCode::non_finite_value);
}

TEST(TornModel, names_the_number_of_blades_before_the_options_and_these_before_a_blade) {
  TornModel model = make_model(test::make_sheet(4));
  const ModelPose pose = rest(model.source());
  TearOptions too_narrow;
  too_narrow.width = -1;
  const auto message = [&](const Stroke& stroke) {
    return std::string(model.tear(pose, stroke, too_narrow).error().text());
  };
  const Blade without_length = {{0.5, 0.5, 0}, {0.5, 0.5, 0}};
  EXPECT_THAT(message({without_length}), HasSubstr("at least two blades"));
  EXPECT_THAT(message({without_length, without_length}), HasSubstr("width"));
}

TEST(TornModel, tears_in_a_pose_with_a_collapsed_bone_without_harm) {
  TornModel model = make_model(test::make_tube(8, 10, 3));
  ModelPose pose = rest(model.source());
  pose.model_from_bone[1].linear().setZero();
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(
        model.tear(pose, test::random_stroke(model.character(), rest(model.source()), random)));
    ASSERT_THAT(test::broken_laws(model), IsEmpty());
    ASSERT_THAT(test::broken_surface(model), IsEmpty());
  }
}

TEST(TornModel, keeps_every_law_at_any_scale_and_far_from_the_origin) {
  Random random(31);
  // The last scale of each rounds the mesh to a size of a few hundred float steps.
  for (const auto& [scale, offset] : {std::pair{1e-5f, 0.0f},
                                      {1e-5f, 0.2f},
                                      {1e-2f, 1e2f},
                                      {1.0f, 1e3f},
                                      {1.0f, 3e4f},
                                      {1e4f, 0.0f},
                                      {1e4f, 1e8f}}) {
    Character character = test::make_tube(12, 14, 3);
    for (Vec3f& position : character.meshes[0].positions)
      position = scale * position + Vec3f(offset, -offset, 0.5f * offset);
    for (Vec3f& delta : character.meshes[0].morph_targets[0].position_deltas) delta *= scale;
    TornModel model = make_model(character);
    const ModelPose pose = *bind_pose(model.source());
    for (int i = 0; i < 5; ++i) {
      ChangeRecord change;
      ASSERT_TRUE(
          model.tear(pose, test::random_stroke(model.character(), pose, random), {}, &change));
      ASSERT_THAT(test::broken_laws(model), IsEmpty())
          << "scale " << scale << ", offset " << offset;
      ASSERT_THAT(test::broken_surface(model), IsEmpty())
          << "scale " << scale << ", offset " << offset;
      ASSERT_THAT(test::broken_lips(model, change), IsEmpty())
          << "scale " << scale << ", offset " << offset;
    }
  }
}

TEST(TornModel, the_same_tears_give_the_same_bits) {
  const auto tear_twice = [] {
    TornModel model = make_model(test::make_tube(10, 12, 4));
    Random random(3);
    for (int i = 0; i < 5; ++i) {
      const ModelPose pose = test::random_pose(model.source(), random);
      EXPECT_TRUE(model.tear(pose, test::random_stroke(model.character(), pose, random)));
    }
    return model.character();
  };
  EXPECT_EQ(tear_twice(), tear_twice());
}

/// The section of a posed mesh with the parallelogram that a blade sweeps when it moves without
/// turning: clipped triangle by triangle, independently of the kernel. Intervals are in [0, 1]
/// along the motion.
struct Section {
  double length = 0;
  std::vector<std::array<double, 2>> intervals;

  /// Whether the blade meets at most one layer at any time.
  [[nodiscard]] bool is_single_layer() {
    std::sort(intervals.begin(), intervals.end());
    for (std::size_t i = 0; i + 1 < intervals.size(); ++i)
      if (intervals[i][1] > intervals[i + 1][0] + 1e-9) return false;
    return true;
  }
};

Section section_of(const Character& character, const ModelPose& pose, const Blade& from,
                   const Vec3d& motion) {
  const Vec3d blade = from.tip - from.base;
  const Vec3d normal = motion.cross(blade).normalized();
  Eigen::Matrix<double, 3, 2> frame;
  frame << motion, blade;
  const Eigen::Matrix<double, 2, 3> inverse =
      (frame.transpose() * frame).inverse() * frame.transpose();
  const auto positions = test::posed_positions(character, 0, pose);
  Section section;
  for (const Triangle& triangle : character.meshes[0].triangles) {
    std::vector<Vec3d> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d a = positions[triangle[k]], b = positions[triangle[(k + 1) % 3]];
      const double at_a = normal.dot(a - from.base), at_b = normal.dot(b - from.base);
      if ((at_a < 0) != (at_b < 0)) ends.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    if (ends.size() != 2) continue;
    const Eigen::Vector2d p = inverse * (ends[0] - from.base), q = inverse * (ends[1] - from.base);
    double begin = 0, end = 1;
    for (int axis = 0; axis < 2; ++axis)
      for (const double limit : {0.0, 1.0}) {
        const double sign = limit == 0.0 ? 1 : -1, in_p = sign * (p[axis] - limit),
                     in_q = sign * (q[axis] - limit);
        if (in_p < 0 && in_q < 0) end = -1;
        if (in_p < 0 && in_q >= 0) begin = std::max(begin, in_p / (in_p - in_q));
        if (in_q < 0 && in_p >= 0) end = std::min(end, in_p / (in_p - in_q));
      }
    if (begin >= end) continue;
    section.length += (end - begin) * (ends[1] - ends[0]).norm();
    const double one = p.x() + begin * (q.x() - p.x()), other = p.x() + end * (q.x() - p.x());
    section.intervals.push_back({std::min(one, other), std::max(one, other)});
  }
  return section;
}

TEST(TornModel, tears_the_whole_section_of_surface_and_sweep) {
  Random random(77);
  int compared = 0;
  for (int i = 0; i < 400; ++i) {
    const std::uint32_t rings = 6 + random.index(20), sides = 6 + random.index(20);
    const Character character = test::make_tube(rings, sides, 3);
    const ModelPose pose = test::random_pose(character, random, 0.5, 1.1);
    const Stroke around =
        test::random_stroke(character, pose, random, random.uniform(0.05, 0.5), 1);
    const Vec3d motion = around[1].base - around[0].base;
    const Stroke stroke = {around[0], {around[0].base + motion, around[0].tip + motion}};
    Section section = section_of(character, pose, stroke[0], motion);
    if (!section.is_single_layer()) continue;  // the result depends on which layer is nearest
    TornModel model = make_model(character);
    const auto report = model.tear(pose, stroke);
    ASSERT_TRUE(report);
    EXPECT_NEAR(report->length_posed, section.length, 0.001 * section.length) << "stroke " << i;
    ++compared;
  }
  EXPECT_GT(compared, 200);
}

void tear_at_random(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  TornModel model = make_model(test::random_character(random));
  for (int i = 0; i < 6; ++i) {
    const ModelPose pose = test::random_pose(model.source(), random);
    const double length = random.uniform(0.02, 0.6);
    const Stroke stroke =
        test::random_stroke(model.character(), pose, random, length, 1 + random.index(8));
    ChangeRecord change;
    const auto report = model.tear(pose, stroke, {}, &change);
    ASSERT_TRUE(report) << report.error().text();
    ASSERT_THAT(test::broken_laws(model), IsEmpty()) << "tear " << i;
    ASSERT_THAT(test::broken_surface(model), IsEmpty()) << "tear " << i;
    ASSERT_THAT(test::broken_lips(model, change), IsEmpty()) << "tear " << i;
    if (i == 0) {
      ASSERT_THAT(test::broken_closure(model), IsEmpty());
    }
  }
  for (int i = 0; i < 5; ++i)
    ASSERT_THAT(
        test::broken_closed_form(model, test::random_pose(model.source(), random, 1.5, 1.5)),
        IsEmpty());
}

class RandomTears : public testing::TestWithParam<int> {};

TEST_P(RandomTears, keep_every_law_in_every_pose) {
  const int rounds = test::stressed(1, 250);
  for (int round = 0; round < rounds && !HasFatalFailure(); ++round)
    tear_at_random(static_cast<std::uint64_t>(200 * round + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(seeds, RandomTears, testing::Range(0, 200));

}  // namespace
}  // namespace sunder
