#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/topology.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::difference;
using test::down_at;
using test::make_model;
using test::Random;
using test::state_of;
using testing::IsEmpty;

TearStroke begin(TornModel& model, const ModelPose& pose, const Blade& blade,
                 const TearOptions& options = {}, const StrokeSampling& sampling = {}) {
  auto stroke = TearStroke::create(model, pose, blade, options, sampling);
  EXPECT_TRUE(stroke) << stroke.error().text();
  return std::move(*stroke);
}

/// A blade that does not reach the sheet.
Blade above(double x, double y) { return {{x, y, 0.5}, {x, y, 0.2}}; }

void expect_same_figures(const TearReport& a, const TearReport& b) {
  EXPECT_EQ(a.runs, b.runs);
  EXPECT_EQ(a.segments, b.segments);
  EXPECT_EQ(a.segments_missed, b.segments_missed);
  EXPECT_EQ(a.faces_crossed, b.faces_crossed);
  EXPECT_EQ(a.points_added, b.points_added);
  EXPECT_EQ(a.vertices_added, b.vertices_added);
  EXPECT_EQ(a.triangles_added, b.triangles_added);
  EXPECT_EQ(a.triangles_retired, b.triangles_retired);
  EXPECT_EQ(a.blocked, b.blocked);
  EXPECT_NEAR(a.length_posed, b.length_posed, 1e-12 * b.length_posed);
  EXPECT_NEAR(a.area_removed_posed, b.area_removed_posed, 1e-12 * b.area_removed_posed);
  EXPECT_EQ(a.pieces.size(), b.pieces.size());
}

void tear_piece_by_piece(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  TornModel at_once = make_model(test::random_character(random)),
            by_pieces = make_model(at_once.source());
  for (int i = 0; i < 3; ++i) {
    const TearOperation tear = test::random_tear(at_once, random, random.index(2) == 0);
    const auto& pose = std::get<ModelPose>(tear.pose);
    const auto expected = at_once.tear(pose, tear.stroke, tear.options);
    ASSERT_TRUE(expected) << expected.error().text();
    TearStroke stroke = begin(by_pieces, pose, tear.stroke[0], tear.options);
    for (std::size_t k = 1; k < tear.stroke.size(); ++k)
      ASSERT_TRUE(stroke.extend(pose, tear.stroke[k]));
    const auto report = stroke.end();
    ASSERT_TRUE(report) << report.error().text();
    expect_same_figures(*report, *expected);
    ASSERT_EQ(difference(state_of(by_pieces), state_of(at_once)), "")
        << "tear " << i << " of width " << tear.options.width;
  }
}

class RandomStrokes : public testing::TestWithParam<int> {};

TEST_P(RandomStrokes, piece_by_piece_are_the_same_bits_as_at_once) {
  const int rounds = test::stressed(1, 50);
  for (int round = 0; round < rounds && !HasFailure(); ++round)
    tear_piece_by_piece(static_cast<std::uint64_t>(100 * round + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(seeds, RandomStrokes, testing::Range(0, 100));

TEST(TearStroke, figures_of_its_pieces_add_up) {
  TornModel model = make_model(test::make_sheet(9));
  const ModelPose pose = *bind_pose(model.source());
  TearStroke stroke = begin(model, pose, down_at(0.2, 0.3));
  EXPECT_EQ(model.character(), model.source()) << "nothing is torn yet";
  TearReport sum;
  for (int i = 1; i <= 8; ++i) {
    const auto report = stroke.extend(pose, down_at(0.2 + 0.07 * i, 0.3 + 0.03 * i));
    ASSERT_TRUE(report);
    EXPECT_EQ(report->segments, 1u);
    EXPECT_GT(report->length_posed, 0.07);
    sum.points_added += report->points_added;
    sum.vertices_added += report->vertices_added;
    sum.triangles_added += report->triangles_added;
    sum.faces_crossed += report->faces_crossed;
    sum.length_posed += report->length_posed;
    EXPECT_THAT(test::broken_laws(model), IsEmpty()) << "valid between two blades too";
    EXPECT_THAT(test::broken_surface(model), IsEmpty());
  }
  const auto report = stroke.end();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->runs, 1u);
  EXPECT_EQ(report->segments, 8u);
  EXPECT_EQ(report->points_added, sum.points_added);
  EXPECT_EQ(report->vertices_added, sum.vertices_added);
  EXPECT_EQ(report->triangles_added, sum.triangles_added);
  EXPECT_EQ(report->faces_crossed, sum.faces_crossed);
  EXPECT_NEAR(report->length_posed, sum.length_posed, 1e-12);
}

TEST(TearStroke, a_miss_is_reported_and_changes_nothing) {
  for (const double width : {0.0, 0.05}) {
    TornModel model = make_model(test::make_sheet(5));
    const ModelPose pose = *bind_pose(model.source());
    const auto before = state_of(model);
    TearOptions options;
    options.width = width;
    TearStroke stroke = begin(model, pose, above(0.2, 0.2), options);
    ChangeRecord change;
    const auto missed = stroke.extend(pose, above(0.4, 0.3), 0.0, &change);
    ASSERT_TRUE(missed);
    EXPECT_EQ(missed->segments, 1u);
    EXPECT_EQ(missed->segments_missed, 1u);
    EXPECT_EQ(missed->runs, 0u);
    EXPECT_TRUE(change.meshes.empty());
    EXPECT_EQ(model.character(), before.character);
    const auto whole = stroke.end(&change);
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->runs, 0u);
    EXPECT_EQ(whole->segments_missed, 1u);
    EXPECT_EQ(difference(state_of(model), before), "");
  }
}

TEST(TearStroke, a_failing_call_changes_nothing_and_the_stroke_continues) {
  TornModel model = make_model(test::make_sheet(6)), straight = make_model(test::make_sheet(6));
  const ModelPose pose = *bind_pose(model.source());
  TearStroke stroke = begin(model, pose, down_at(0.2, 0.3));
  ASSERT_TRUE(stroke.extend(pose, down_at(0.5, 0.4)));
  const auto before = state_of(model);
  Blade flipped = down_at(0.6, 0.5);
  std::swap(flipped.base, flipped.tip);
  EXPECT_EQ(stroke.extend(pose, flipped).error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(stroke.extend(pose, Blade{}).error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(stroke.extend(ModelPose{}, down_at(0.6, 0.5)).error().code(),
            StatusCode::size_mismatch);
  EXPECT_EQ(difference(state_of(model), before), "");
  ASSERT_TRUE(stroke.extend(pose, down_at(0.8, 0.5)));
  ASSERT_TRUE(stroke.end());
  ASSERT_TRUE(straight.tear(pose, Stroke{down_at(0.2, 0.3), down_at(0.5, 0.4), down_at(0.8, 0.5)}));
  EXPECT_EQ(difference(state_of(model), state_of(straight)), "");
}

TEST(TearStroke, bad_options_are_refused_at_its_begin) {
  TornModel model = make_model(test::make_sheet(4));
  const ModelPose pose = *bind_pose(model.source());
  TearOptions options;
  options.width = -1;
  EXPECT_EQ(TearStroke::create(model, pose, down_at(0.2, 0.2), options).error().code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(TearStroke::create(model, pose, Blade{}).error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(TearStroke::create(model, ModelPose{}, down_at(0.2, 0.2)).error().code(),
            StatusCode::size_mismatch);
  StrokeSampling sampling;
  sampling.minimum_distance = -1;
  EXPECT_EQ(TearStroke::create(model, pose, down_at(0.2, 0.2), {}, sampling).error().code(),
            StatusCode::invalid_argument);
  EXPECT_TRUE(model.tear(pose, Stroke{down_at(0.2, 0.3), down_at(0.5, 0.4)}))
      << "none of these is under way";
}

/// Extends a stroke by blades at some times, and expects that exactly the blades at `taken`, and
/// the last one, are torn.
void expect_taken(const std::vector<std::pair<Blade, double>>& blades,
                  const StrokeSampling& sampling, const std::vector<std::size_t>& taken,
                  double width) {
  TornModel model = make_model(test::make_sheet(8)), expected = make_model(model.source());
  const ModelPose pose = *bind_pose(model.source());
  TearOptions options;
  options.width = width;
  Stroke stroke_taken = {blades[0].first};
  TearStroke stroke = begin(model, pose, blades[0].first, options, sampling);
  for (std::size_t i = 1; i < blades.size(); ++i) {
    const bool is_taken = std::find(taken.begin(), taken.end(), i) != taken.end();
    const auto before = model.character();
    const auto report = stroke.extend(pose, blades[i].first, blades[i].second);
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_EQ(report->segments, is_taken ? 1u : 0u) << "blade " << i;
    if (!is_taken) {
      EXPECT_EQ(model.character(), before) << "blade " << i;
    }
    if (is_taken || i + 1 == blades.size()) stroke_taken.push_back(blades[i].first);
  }
  const auto report = stroke.end();
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->segments, stroke_taken.size() - 1);
  ASSERT_TRUE(expected.tear(pose, stroke_taken, options));
  EXPECT_EQ(difference(state_of(model), state_of(expected)), "");
}

TEST(TearStroke, takes_up_blades_by_distance_and_the_last_one_at_the_end) {
  std::vector<std::pair<Blade, double>> blades;
  for (int i = 0; i <= 10; ++i) blades.emplace_back(down_at(0.15 + 0.0625 * i, 0.3), 0.0);
  StrokeSampling sampling;
  sampling.minimum_distance = 0.18;
  for (const double width : {0.0, 0.03}) {
    expect_taken(blades, sampling, {3, 6, 9}, width);
    expect_taken(blades, {}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, width);
  }
}

TEST(TearStroke, takes_up_blades_of_which_only_the_tip_moved) {
  const Blade from = down_at(0.3, 0.3);
  Blade slightly = from, far = from;
  slightly.tip.x() += 0.05;
  far.tip.x() += 0.3;
  StrokeSampling sampling;
  sampling.minimum_distance = 0.1;
  expect_taken({{from, 0.0}, {slightly, 0.0}, {far, 0.0}}, sampling, {2}, 0.0);
}

TEST(TearStroke, takes_up_blades_by_time) {
  std::vector<std::pair<Blade, double>> blades;
  for (int i = 0; i <= 10; ++i) blades.emplace_back(down_at(0.15 + 0.0625 * i, 0.3), 0.25 * i);
  StrokeSampling sampling;
  sampling.minimum_seconds = 0.5;
  expect_taken(blades, sampling, {2, 4, 6, 8, 10}, 0.0);
  sampling.minimum_distance = 0.18;  // both must have passed
  expect_taken(blades, sampling, {3, 6, 9}, 0.0);
}

TEST(TearStroke, time_does_not_go_back) {
  TornModel model = make_model(test::make_sheet(4));
  const ModelPose pose = *bind_pose(model.source());
  TearStroke stroke = begin(model, pose, down_at(0.2, 0.2));
  ASSERT_TRUE(stroke.extend(pose, down_at(0.4, 0.3), 2.0));
  const auto before = state_of(model);
  EXPECT_EQ(stroke.extend(pose, down_at(0.6, 0.4), 1.0).error().code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(difference(state_of(model), before), "");
}

TEST(TearStroke, while_under_way_its_model_refuses_other_operations) {
  TornModel model = make_model(test::make_sheet(6));
  const ModelPose pose = *bind_pose(model.source());
  const Stroke other = {down_at(0.2, 0.7), down_at(0.6, 0.8)};
  ASSERT_TRUE(model.tear(pose, Stroke{down_at(0.8, 0.1), down_at(0.9, 0.2)}));
  ASSERT_TRUE(model.tear(pose, Stroke{down_at(0.8, 0.5), down_at(0.9, 0.6)}));
  ASSERT_TRUE(model.undo());
  TearStroke stroke = begin(model, pose, down_at(0.2, 0.3));
  ASSERT_TRUE(stroke.extend(pose, down_at(0.5, 0.4)));
  const auto before = state_of(model);
  Bore bore;
  bore.radius = bore.depth = 0.1;
  EXPECT_EQ(TearStroke::create(model, pose, other[0]).error().code(), StatusCode::invalid_argument);
  EXPECT_FALSE(model.tear(pose, other));
  EXPECT_FALSE(model.cut(pose, PlaneCut{}));
  EXPECT_FALSE(model.drill(pose, bore));
  EXPECT_FALSE(model.undo());
  EXPECT_FALSE(model.redo());
  EXPECT_FALSE(model.compact());
  EXPECT_EQ(difference(state_of(model), before), "");
  ASSERT_TRUE(stroke.end());
  EXPECT_TRUE(model.tear(pose, other));
}

TEST(TearStroke, that_goes_out_of_scope_is_cancelled_but_not_when_it_was_moved) {
  TornModel model = make_model(test::make_sheet(6));
  const ModelPose pose = *bind_pose(model.source());
  TearOptions options;
  options.width = 0.04;
  {
    std::optional<TearStroke> stroke = begin(model, pose, down_at(0.2, 0.3), options);
    EXPECT_TRUE(stroke->extend(pose, down_at(0.5, 0.4)));
    TearStroke moved = std::move(*stroke);
    stroke.reset();
    EXPECT_TRUE(model.is_in_stroke());
    EXPECT_TRUE(moved.extend(pose, down_at(0.7, 0.4)));
    EXPECT_NE(model.character(), model.source());
  }
  EXPECT_FALSE(model.is_in_stroke());
  EXPECT_EQ(model.undo_count(), 0u);
  EXPECT_EQ(model.character(), model.source());
}

TEST(TearStroke, continues_if_its_model_was_moved) {
  TornModel model = make_model(test::make_sheet(6)), straight = make_model(model.source());
  const ModelPose pose = *bind_pose(model.source());
  TearStroke stroke = begin(model, pose, down_at(0.2, 0.3));
  ASSERT_TRUE(stroke.extend(pose, down_at(0.5, 0.4)));
  TornModel elsewhere = std::move(model);
  ASSERT_TRUE(stroke.extend(pose, down_at(0.8, 0.3)));
  ASSERT_TRUE(stroke.end());
  ASSERT_TRUE(straight.tear(pose, Stroke{down_at(0.2, 0.3), down_at(0.5, 0.4), down_at(0.8, 0.3)}));
  EXPECT_EQ(difference(state_of(elsewhere), state_of(straight)), "");
}

TEST(TearStroke, once_ended_leaves_the_next_one_alone) {
  TornModel model = make_model(test::make_sheet(6));
  const ModelPose pose = *bind_pose(model.source());
  auto first = std::make_unique<TearStroke>(begin(model, pose, down_at(0.2, 0.3)));
  ASSERT_TRUE(first->extend(pose, down_at(0.5, 0.4)));
  ASSERT_TRUE(first->end());
  TearStroke second = begin(model, pose, down_at(0.2, 0.7));
  EXPECT_FALSE(first->extend(pose, down_at(0.8, 0.3)));
  EXPECT_FALSE(first->end());
  first.reset();
  EXPECT_TRUE(second.extend(pose, down_at(0.5, 0.8)));
  EXPECT_TRUE(second.end());
  EXPECT_EQ(model.undo_count(), 2u);
}

TEST(TearStroke, is_one_operation_to_undo) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(test::random_character(random));
    ASSERT_TRUE(test::play(model, test::random_tear(model, random, true)));
    const auto before = state_of(model);
    const std::uint32_t count_before = model.undo_count();
    const TearOperation tear = test::random_tear(model, random, seed % 2 == 1);
    {
      TearStroke stroke =
          begin(model, std::get<ModelPose>(tear.pose), tear.stroke[0], tear.options);
      for (std::size_t i = 1; i < tear.stroke.size(); ++i)
        ASSERT_TRUE(
            stroke.extend(test::random_pose(model.source(), random, 0.1, 1.0), tear.stroke[i]));
      ASSERT_TRUE(stroke.end());
    }
    if (model.undo_count() == count_before) continue;  // it missed
    EXPECT_EQ(model.undo_count(), count_before + 1);
    const auto after = state_of(model);
    ASSERT_TRUE(model.undo());
    EXPECT_EQ(difference(state_of(model), before), "");
    ASSERT_TRUE(model.redo());
    EXPECT_EQ(difference(state_of(model), after), "");
  }
}

/// A blade at position (u, v) of the posed sheet of `cells` squares, along its normal there.
Blade on_posed_sheet(const Character& sheet, const ModelPose& pose, std::uint32_t cells, double u,
                     double v) {
  const auto positions = test::posed_positions(sheet, 0, pose);
  const auto column = static_cast<std::uint32_t>(u * cells),
             row = static_cast<std::uint32_t>(v * cells);
  const std::uint32_t corner = row * (cells + 1) + column;
  const Vec3d right = positions[corner + 1] - positions[corner],
              up = positions[corner + cells + 1] - positions[corner];
  const Vec3d at = positions[corner] + (u * cells - column) * right + (v * cells - row) * up;
  const Vec3d normal = right.cross(up).normalized();
  return {at + 0.2 * normal, at - 0.2 * normal};
}

/// Far more than a character moves from one frame to the next.
constexpr double kAngle = 0.1;

class StrokesInMotion : public testing::TestWithParam<int> {};

TEST_P(StrokesInMotion, go_on_from_the_tip_and_leave_no_bridge) {
  Random random(static_cast<std::uint64_t>(GetParam()));
  const std::uint32_t cells = 6 + random.index(8);
  TornModel model = make_model(test::make_sheet(cells));
  TearOptions options;
  if (GetParam() % 2 == 1) options.width = 0.02;
  const auto pose = [&] { return test::random_pose(model.source(), random, kAngle, 1.02); };
  const auto height = [&](double u) { return 0.5 + 0.15 * std::sin(5 * u + GetParam()); };
  const ModelPose first = pose();
  TearStroke stroke =
      begin(model, first, on_posed_sheet(model.source(), first, cells, 0.2, height(0.2)), options);
  for (int i = 1; i <= 6; ++i) {
    const ModelPose now =
        i == 1 ? first : pose();  // until something is torn there is no tip to continue from
    const double u = 0.2 + 0.1 * i;
    const auto report =
        stroke.extend(now, on_posed_sheet(model.source(), now, cells, u, height(u)));
    ASSERT_TRUE(report) << report.error().text();
    ASSERT_EQ(report->segments_missed, 0u);
    ASSERT_THAT(test::broken_laws(model), IsEmpty());
    ASSERT_THAT(test::broken_surface(model), IsEmpty());
  }
  const auto report = stroke.end();
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->runs, 1u);
  EXPECT_EQ(report->segments, 6u);
  const TopologyCounts after = *count_topology(model.character());
  EXPECT_EQ(after.boundary_loops, 2u) << "the sheet's border and one slit";
  EXPECT_EQ(after.components, 1u);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(seeds, StrokesInMotion, testing::Range(0, 100));

TEST(TearStroke, continues_if_the_character_moves_farther_than_the_blade_reaches) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(test::make_sheet(9));
    const ModelPose pose = *bind_pose(model.source());
    TearOptions options;
    if (seed % 2 == 1) options.width = 0.02;
    TearStroke stroke = begin(model, pose, down_at(0.2, 0.3), options);
    for (int i = 1; i <= 5; ++i) {
      Affine3d leap = Affine3d::Identity();
      if (i > 1) {  // until something is torn there is no tip to continue from
        leap = Eigen::AngleAxisd{random.uniform(-0.3, 0.3), random.direction()};
        leap.pretranslate(Vec3d(3 * random.direction()));
      }
      ModelPose moved = pose;
      for (Affine3d& bone : moved.model_from_bone) bone = leap * bone;
      const Blade blade = down_at(0.2 + 0.11 * i, 0.3 + 0.05 * i);
      ASSERT_TRUE(stroke.extend(moved, {leap * blade.base, leap * blade.tip}));
    }
    const auto report = stroke.end();
    ASSERT_TRUE(report);
    EXPECT_EQ(report->runs, 1u);
    EXPECT_EQ(report->segments_missed, 0u);
    EXPECT_NEAR(report->length_posed, std::hypot(0.55, 0.25), options.width == 0 ? 0.005 : 0.1);
    EXPECT_EQ(count_topology(model.character())->boundary_loops, 2u);
    EXPECT_THAT(test::broken_laws(model), IsEmpty());
    EXPECT_THAT(test::broken_surface(model), IsEmpty());
  }
}

}  // namespace
}  // namespace sunder
