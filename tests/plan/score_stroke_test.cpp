// The mark of a stroke: a planned one is near the best, and one that is changed in one way loses
// by that way alone.

#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plan/plan_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using testing::HasSubstr;

/// A planned cut across the front of a tube that bends, and its blades.
struct PlannedCut {
  std::shared_ptr<const Character> character;
  WoundTarget target;
  PlanTiming timing;
  PlannedMotion planned;
  BladeSweep sweep;

  [[nodiscard]] Result<StrokeScore> score(const BladeSweep& of) const {
    const auto tear = tear_of_sweep(of, timing.pose, timing.clip_speed);
    if (!tear) return tear.error();
    return score_stroke(character, target, timing, *tear, of.times);
  }
};

const PlannedCut& planned_cut() {
  static const PlannedCut made = [] {
    PlannedCut cut;
    cut.character = std::make_shared<const Character>(test::make_tube(80, 96, 3));
    cut.timing.pose = ClipPose{"Bend", 0.2};
    cut.timing.clip_speed = 0.3;
    // Seen from the front, the curve is smooth.
    const auto model = TornModel::create(cut.character);
    auto query = SurfaceQuery::create(*model);
    if (!query->set_pose(*make_pose(*cut.character, cut.timing.pose))) return cut;
    for (int i = 0; i <= 60; ++i) {
      const Vec3d from(0.03 * std::sin(4 * i / 60.0), 0.5 + 0.4 * i / 60.0, 1);
      cut.target.places.push_back((*query->cast_ray({from, -Vec3d::UnitZ(), 2}))->anchor);
    }
    cut.target.depth = {0.02};
    const auto hand = free_hand(cut.character, cut.target, cut.timing, 0.12);
    auto planned = plan_motion(cut.character, cut.target, cut.timing, *hand);
    cut.planned = *planned;
    const auto motion = RobotMotion::create(hand->robot, cut.planned.trajectory);
    SweepOptions options;
    options.seconds = 1.0 / 240;
    cut.sweep = *sweep_blade(*motion, hand->blade, hand->world_from_root, options);
    return cut;
  }();
  return made;
}

/// The same stroke with changed blades.
BladeSweep changed(const std::function<void(Blade&, double time)>& change) {
  BladeSweep sweep = planned_cut().sweep;
  for (std::size_t i = 0; i < sweep.blades.size(); ++i) change(sweep.blades[i], sweep.times[i]);
  return sweep;
}

void move(Blade& blade, const Vec3d& by) {
  blade.base += by;
  blade.tip += by;
}

/// The marks but for the whole one.
std::vector<double> parts(const StrokeScore& score) {
  const StrokeScore::Marks& marks = score.marks;
  return {marks.covered, marks.place, marks.depth, marks.angle, *marks.speed, *marks.smoothness};
}
enum Part : std::uint8_t { kCovered, kPlace, kDepth, kAngle, kSpeed, kSmoothness };

/// Checks that a stroke loses at least `loss` in one part, and at most 5 in all others.
void expect_loss(const BladeSweep& sweep, Part part, double loss) {
  const auto good = planned_cut().score(planned_cut().sweep);
  const auto score = planned_cut().score(sweep);
  ASSERT_TRUE(score) << score.error().text();
  const std::vector<double> before = parts(*good), after = parts(*score);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (i == part)
      EXPECT_LT(after[i], before[i] - loss) << i;
    else
      EXPECT_GT(after[i], before[i] - 5) << i;
  }
  EXPECT_LT(score->marks.whole, good->marks.whole);
}

TEST(ScoreStroke, a_planned_motion_is_near_the_best) {
  ASSERT_TRUE(planned_cut().planned.report.is_reachable);
  const auto score = planned_cut().score(planned_cut().sweep);
  ASSERT_TRUE(score) << score.error().text();
  EXPECT_GT(score->marks.whole, 93);
  EXPECT_GT(score->covered, 0.98);
  EXPECT_FALSE(score->is_backwards);
  for (const double part : parts(*score)) EXPECT_GT(part, 90);
  // Measured on the surface itself, not along the path that plans follow.
  EXPECT_LE(score->place.most, score->tolerance);
  EXPECT_NEAR(score->wanted_depth, 0.02, 1e-9);
  EXPECT_NEAR(score->pace->speed, score->pace->wanted_speed, 0.05 * score->pace->wanted_speed);
  EXPECT_NEAR(score->pace->seconds, planned_cut().timing.cut, 0.2);
}

TEST(ScoreStroke, a_stroke_beside_the_curve_loses_in_its_place) {
  const double tolerance = planned_cut().planned.report.tolerance;
  const BladeSweep beside = changed([&](Blade& blade, double) {
    move(blade, {2 * tolerance, 0, 0});
  });
  expect_loss(beside, kPlace, 25);
  const auto score = planned_cut().score(beside);
  EXPECT_GT(score->place.mean, 1.2 * tolerance);  // parts of the curve are oblique
  EXPECT_LT(score->place.mean, 2.2 * tolerance);
}

TEST(ScoreStroke, depths_lose_in_depth_and_say_in_which_direction) {
  for (const double more : {0.01, -0.01}) {
    const BladeSweep other = changed([&](Blade& blade, double) {
      move(blade, more * Vec3d((blade.tip - blade.base).normalized()));
    });
    const auto score = planned_cut().score(other);
    ASSERT_TRUE(score);
    EXPECT_NEAR(more > 0 ? score->too_deep.mean : score->too_shallow.mean, 0.01, 0.002);
    EXPECT_LT(more > 0 ? score->too_shallow.mean : score->too_deep.mean, 0.001);
    expect_loss(other, kDepth, 35);
  }
}

TEST(ScoreStroke, a_blade_that_leans_loses_in_angle) {
  const auto clean = planned_cut().score(planned_cut().sweep);
  const BladeSweep leaning = changed([](Blade& blade, double) {
    // About its entry, and pushed in until it is as deep as before.
    const Vec3d entry = blade.tip + 0.02 * (blade.base - blade.tip).normalized();
    const Eigen::AngleAxisd turn(0.35, Eigen::Vector3d::UnitX());
    blade.base = entry + turn * Vec3d(blade.base - entry);
    blade.tip = entry + turn * Vec3d(blade.tip - entry) / std::cos(0.35);
  });
  const auto score = planned_cut().score(leaning);
  ASSERT_TRUE(score);
  EXPECT_NEAR(score->angle.mean, 0.35, 0.06);
  EXPECT_GT(score->marks.place, clean->marks.place - 5);
  expect_loss(leaning, kAngle, 35);
}

TEST(ScoreStroke, a_tremor_loses_in_smoothness) {
  const BladeSweep shaken = changed([](Blade& blade, double time) {
    move(blade, {6e-4 * std::sin(2 * std::numbers::pi * 9 * time), 0, 0});
  });
  expect_loss(shaken, kSmoothness, 20);
}

TEST(ScoreStroke, the_clock_alone_changes_speed) {
  PlannedCut cut = planned_cut();
  cut.timing.clip_speed = 0;
  const auto hand = free_hand(cut.character, cut.target, cut.timing, 0.12);
  const auto planned = plan_motion(cut.character, cut.target, cut.timing, *hand);
  const auto motion = RobotMotion::create(hand->robot, planned->trajectory);
  SweepOptions options;
  options.seconds = 1.0 / 240;
  BladeSweep sweep = *sweep_blade(*motion, hand->blade, hand->world_from_root, options);
  const auto good = cut.score(sweep);
  ASSERT_TRUE(good);
  for (double& time : sweep.times) time *= 2;
  const auto slow = cut.score(sweep);
  ASSERT_TRUE(slow);
  EXPECT_NEAR(slow->pace->speed, 0.5 * good->pace->speed, 1e-9);
  EXPECT_NEAR(slow->pace->unevenness, good->pace->unevenness, 1e-9);
  EXPECT_LT(*slow->marks.speed, *good->marks.speed - 30);
  EXPECT_NEAR(slow->marks.place, good->marks.place, 1e-9);
  cut.timing.may_take_longer = true;
  EXPECT_GT(*cut.score(sweep)->marks.speed, *good->marks.speed - 5);
  cut.timing.may_take_longer = false;
  // It slows down and hurries, smoothly.
  for (double& time : sweep.times) time = 0.5 * time + 0.06 * std::sin(10 * 0.5 * time);
  const auto uneven = cut.score(sweep);
  ASSERT_TRUE(uneven) << uneven.error().text();
  EXPECT_GT(uneven->pace->unevenness, 0.3);
  EXPECT_LT(*uneven->marks.speed, *good->marks.speed - 30);
  EXPECT_NEAR(uneven->marks.depth, good->marks.depth, 1e-9);
}

TEST(ScoreStroke, half_a_stroke_covers_half) {
  BladeSweep half = planned_cut().sweep;
  const double middle =
      0.5 * (planned_cut().planned.report.cut_begins + planned_cut().planned.report.cut_ends);
  while (half.times.back() > middle) {
    half.times.pop_back();
    half.blades.pop_back();
  }
  const auto score = planned_cut().score(half);
  ASSERT_TRUE(score);
  EXPECT_NEAR(score->covered, 0.5, 0.02);
  EXPECT_LT(score->marks.whole, 51);
  expect_loss(half, kCovered, 45);
}

TEST(ScoreStroke, a_stroke_from_the_other_end_is_known_as_such) {
  PlannedCut cut = planned_cut();
  cut.timing.clip_speed = 0;  // poses are those of the blades; here there is one
  BladeSweep sweep = *[&]() -> std::optional<BladeSweep> {
    const auto hand = free_hand(cut.character, cut.target, cut.timing, 0.12);
    const auto planned = plan_motion(cut.character, cut.target, cut.timing, *hand);
    const auto motion = RobotMotion::create(hand->robot, planned->trajectory);
    SweepOptions options;
    options.seconds = 1.0 / 240;
    return *sweep_blade(*motion, hand->blade, hand->world_from_root, options);
  }();
  const auto there = cut.score(sweep);
  std::reverse(sweep.blades.begin(), sweep.blades.end());
  const double end = sweep.times.back();
  std::reverse(sweep.times.begin(), sweep.times.end());
  for (double& time : sweep.times) time = end - time;
  const auto back = cut.score(sweep);
  ASSERT_TRUE(there && back);
  EXPECT_TRUE(back->is_backwards);
  EXPECT_NEAR(back->place.mean, there->place.mean, 0.05 * there->tolerance);
  EXPECT_NEAR(back->covered, there->covered, 0.01);
}

TEST(ScoreStroke, closed_curves_may_begin_anywhere) {
  const PlannedCut& cut = planned_cut();
  PlanTiming timing;
  timing.pose = ClipPose{"Bend", 0.2};
  const ModelPose pose = *make_pose(*cut.character, timing.pose);
  std::vector<Vec3d> ring, from_elsewhere;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2 * std::numbers::pi * i / 24;
    ring.emplace_back(0.08 * std::sin(angle), 0.7 + 0.08 * std::cos(angle), 0.3);
  }
  from_elsewhere = ring;
  std::rotate(from_elsewhere.begin(), from_elsewhere.begin() + 9, from_elsewhere.end());
  WoundTarget target, other;
  target.places = test::nearest_places(cut.character, pose, ring);
  other.places = test::nearest_places(cut.character, pose, from_elsewhere);
  target.is_closed = other.is_closed = true;
  const auto hand = free_hand(cut.character, other, timing, 0.1);
  const auto planned = plan_motion(cut.character, other, timing, *hand);
  ASSERT_TRUE(planned) << planned.error().text();
  const auto score = score_stroke(cut.character, target, timing, planned->tear);
  ASSERT_TRUE(score) << score.error().text();
  EXPECT_GT(score->covered, 0.97);
  EXPECT_LT(score->place.mean, 0.5 * score->tolerance);
}

TEST(ScoreStroke, without_times_speed_is_not_judged) {
  const PlannedCut& cut = planned_cut();
  const auto score = score_stroke(cut.character, cut.target, cut.timing, cut.planned.tear);
  ASSERT_TRUE(score) << score.error().text();
  EXPECT_FALSE(score->pace || score->marks.speed || score->marks.smoothness);
  EXPECT_GT(score->marks.whole, 93);
}

TEST(ScoreStroke, a_blade_that_meets_nothing_has_the_mark_0) {
  const auto score = planned_cut().score(changed([](Blade& blade, double) {
    move(blade, {0, 0, 2});
  }));
  ASSERT_TRUE(score) << score.error().text();
  EXPECT_EQ(score->blades, 0u);
  EXPECT_EQ(score->marks.whole, 0);
  EXPECT_EQ(score->covered, 0);
}

TEST(ScoreStroke, faults_are_named) {
  const PlannedCut& cut = planned_cut();
  const auto refused = [&](const TearOperation& tear, const std::vector<double>& times,
                           StatusCode code, const char* text) {
    const auto score = score_stroke(cut.character, cut.target, cut.timing, tear, times);
    ASSERT_FALSE(score);
    EXPECT_EQ(score.error().code(), code);
    EXPECT_THAT(std::string(score.error().text()), HasSubstr(text));
  };
  TearOperation tear = cut.planned.tear;
  refused(tear, {0, 1}, StatusCode::size_mismatch, "2 times");
  std::vector<double> times(tear.stroke.size(), 0.0);
  refused(tear, times, StatusCode::invalid_argument, "blade 1 is at 0 s");
  tear.stroke[3].tip.x() = std::numeric_limits<double>::quiet_NaN();
  refused(tear, {}, StatusCode::non_finite_value, "blade 3");
  tear = cut.planned.tear;
  tear.stroke[2].tip = tear.stroke[2].base;
  refused(tear, {}, StatusCode::invalid_argument, "blade 2 has no length");
  tear = cut.planned.tear;
  tear.pose_changes = {{5, RestPose{}}, {4, RestPose{}}};
  refused(tear, {}, StatusCode::invalid_argument, "blade 4");
  tear.stroke.resize(1);
  refused(tear, {}, StatusCode::empty_input, "1 blades");
  EXPECT_FALSE(score_stroke(nullptr, cut.target, cut.timing, cut.planned.tear));
  EXPECT_FALSE(score_stroke(cut.character, cut.target, cut.timing, cut.planned.tear, {}, -1));
}

}  // namespace
}  // namespace sunder
