// Trajectories, and the sweeps of blades, against closed forms of a planar arm.

#include <sunder/robot/trajectory.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robot/planar_arm.h"
#include "support/machine/random.h"

namespace sunder {
namespace {

using test::blade_across;
using test::make_planar_arm;
using testing::HasSubstr;

RobotMotion motion_of(const RobotTrajectory& trajectory, const RobotMotionOptions& options = {}) {
  auto motion = RobotMotion::create(make_planar_arm(), trajectory, options);
  EXPECT_TRUE(motion) << motion.error().text();
  return std::move(*motion);
}

/// The shoulder turns from 0 by an angle within a second; the elbow is straight.
RobotTrajectory turn(double angle) { return {{"shoulder"}, {0, 1}, {0, angle}}; }

BladeSweep sweep(const RobotMotion& motion, const SweepOptions& options = {}) {
  auto found = sweep_blade(motion, blade_across(), Affine3d::Identity(), options);
  EXPECT_TRUE(found) << found.error().text();
  return found ? std::move(*found) : BladeSweep();
}

double length_of(const Stroke& blades) {
  double length = 0;
  for (std::size_t i = 1; i < blades.size(); ++i)
    length += (blades[i].tip - blades[i - 1].tip).norm();
  return length;
}

TEST(RobotMotion, values_change_evenly_between_times_and_are_held_outside) {
  const RobotMotion motion =
      motion_of({{"elbow", "shoulder"}, {1, 2, 4}, {0, 0.5, 1, 0.7, -1, 0.7}});
  EXPECT_EQ(motion.first_time(), 1);
  EXPECT_EQ(motion.last_time(), 4);
  std::array<double, 2> values{};
  const auto at = [&](double time) {
    EXPECT_TRUE(motion.values_at(time, values));
    return values;
  };
  EXPECT_EQ(at(0), (std::array<double, 2>{0.5, 0}));
  EXPECT_EQ(at(1), (std::array<double, 2>{0.5, 0}));
  EXPECT_DOUBLE_EQ(at(1.25)[0], 0.55);
  EXPECT_DOUBLE_EQ(at(1.25)[1], 0.25);
  EXPECT_EQ(at(2), (std::array<double, 2>{0.7, 1}));
  EXPECT_DOUBLE_EQ(at(3)[1], 0);
  EXPECT_EQ(at(4), (std::array<double, 2>{0.7, -1}));
  EXPECT_EQ(at(9), (std::array<double, 2>{0.7, -1}));
  EXPECT_EQ(motion.values_at(std::nan(""), values).code(), StatusCode::non_finite_value);
  EXPECT_EQ(motion.values_at(0, std::span(values).first(1)).code(), StatusCode::size_mismatch);
}

TEST(RobotMotion, values_without_a_name_rest) {
  std::array<double, 2> values{};
  ASSERT_TRUE(motion_of({{"elbow"}, {0}, {0.4}}).values_at(3, values));
  EXPECT_EQ(values, (std::array<double, 2>{0, 0.4}));
  ASSERT_TRUE(motion_of({{}, {0}, {}}).values_at(3, values));
  EXPECT_EQ(values, (std::array<double, 2>{0, 0}));
}

TEST(RobotMotion, limits_are_reported_where_they_are_exceeded_most_and_kept_if_wanted) {
  const RobotTrajectory wild = {{"shoulder", "elbow"}, {0, 1, 2, 3}, {0, 1, 3.5, 1, 4, 1, 0, -1}};
  const RobotMotion motion = motion_of(wild);
  ASSERT_EQ(motion.excesses().size(), 1u);
  EXPECT_EQ(motion.excesses()[0].value, 0u);
  EXPECT_EQ(motion.excesses()[0].time, 2);
  EXPECT_EQ(motion.excesses()[0].number, 4);
  std::array<double, 2> values{};
  ASSERT_TRUE(motion.values_at(2, values));
  EXPECT_EQ(values[0], 4);

  const RobotMotion kept = motion_of(wild, {true});
  ASSERT_EQ(kept.excesses().size(), 1u);
  ASSERT_TRUE(kept.values_at(2, values));
  EXPECT_EQ(values[0], std::numbers::pi);
  EXPECT_TRUE(motion_of(turn(3)).excesses().empty());
}

TEST(RobotMotion, wrong_trajectories_are_refused_with_their_cause) {
  const auto error = [](const RobotTrajectory& trajectory) {
    const auto motion = RobotMotion::create(make_planar_arm(), trajectory);
    EXPECT_FALSE(motion);
    return motion ? std::string() : std::string(motion.error().text());
  };
  EXPECT_THAT(error({{"elbow"}, {}, {}}), HasSubstr("no time"));
  EXPECT_THAT(error({{"elbow"}, {0, 1}, {0}}), HasSubstr("1 values, expected 2 times x 1"));
  EXPECT_THAT(error({{"elbow"}, {0, 1, 1}, {0, 0, 0}}), HasSubstr("time 2, 1 s, does not come"));
  EXPECT_THAT(error({{"elbow"}, {0, std::nan("")}, {0, 0}}), HasSubstr("time 1 is not finite"));
  EXPECT_THAT(error({{"elbow"}, {0, 1}, {0, INFINITY}}), HasSubstr("'elbow' is not finite"));
  EXPECT_THAT(error({{"elbwo"}, {0}, {0}}), HasSubstr("did you mean 'elbow'?"));
  EXPECT_THAT(error({{"elbow", "elbow"}, {0}, {0, 0}}), HasSubstr("occurs twice"));
}

TEST(SweepBlade, a_turning_arm_draws_a_circle) {
  for (const double angle : {0.3, 1.0, 3.0, 2 * std::numbers::pi, 20.0}) {
    const BladeSweep found = sweep(motion_of(turn(angle)));
    ASSERT_EQ(found.blades.size(), found.times.size());
    EXPECT_EQ(found.times.front(), 0);
    EXPECT_EQ(found.times.back(), 1);
    for (std::size_t i = 0; i < found.blades.size(); ++i) {
      const double at = angle * found.times[i];
      const Vec3d expected(2 * std::cos(at), 2 * std::sin(at), 0.1);
      EXPECT_LE((found.blades[i].base - expected).norm(), 1e-12);
      EXPECT_NEAR(found.blades[i].tip.z(), -0.1, 1e-12);
      if (i == 0) continue;
      const double step = (found.blades[i].base - found.blades[i - 1].base).norm();
      EXPECT_LE(step, 0.002);
      EXPECT_GE(step, 0.0009);  // steps are halved until they fit
    }
    EXPECT_NEAR(length_of(found.blades), 2 * angle, 2e-6 * angle);
  }
}

TEST(SweepBlade, a_finer_sampling_stays_on_the_same_path) {
  test::Random random(1);
  for (int i = 0; i < 20; ++i) {
    RobotTrajectory trajectory{{"shoulder", "elbow"}, {}, {}};
    for (int key = 0; key < 5; ++key) {
      trajectory.times.push_back(key);
      for (int v = 0; v < 2; ++v) trajectory.values.push_back(random.uniform(-2, 2));
    }
    const RobotMotion motion = motion_of(trajectory);
    SweepOptions coarse, fine;
    coarse.spacing = 0.02;
    fine.spacing = 0.002;
    const BladeSweep of_coarse = sweep(motion, coarse), of_fine = sweep(motion, fine);
    EXPECT_GT(of_fine.blades.size(), 5 * of_coarse.blades.size());
    std::size_t segment = 1;
    for (std::size_t b = 0; b < of_fine.blades.size(); ++b) {
      while (segment + 1 < of_coarse.times.size() && of_coarse.times[segment] < of_fine.times[b])
        ++segment;
      const double share = (of_fine.times[b] - of_coarse.times[segment - 1]) /
                           (of_coarse.times[segment] - of_coarse.times[segment - 1]);
      const Vec3d on_chord =
          of_coarse.blades[segment - 1].tip +
          share * (of_coarse.blades[segment].tip - of_coarse.blades[segment - 1].tip);
      EXPECT_LE((of_fine.blades[b].tip - on_chord).norm(), 0.25 * coarse.spacing);
    }
  }
}

TEST(SweepBlade, a_blade_that_stands_still_gives_no_blades_unless_time_asks_for_them) {
  const RobotTrajectory pause = {{"shoulder"}, {0, 1, 3, 4}, {0, 0.1, 0.1, 0.2}};
  const BladeSweep found = sweep(motion_of(pause));
  for (std::size_t i = 1; i < found.blades.size(); ++i)
    EXPECT_GT((found.blades[i].tip - found.blades[i - 1].tip).norm(), 1e-6);
  SweepOptions options;
  options.seconds = 0.1;
  std::size_t standing = 0;
  const BladeSweep timed = sweep(motion_of(pause), options);
  for (std::size_t i = 1; i < timed.times.size(); ++i) {
    EXPECT_LE(timed.times[i] - timed.times[i - 1], 0.1 + 1e-12);
    if (timed.times[i] > 1 && timed.times[i] < 3) ++standing;
  }
  EXPECT_GE(standing, 18u);
  const auto never =
      sweep_blade(motion_of({{"elbow"}, {0, 1}, {0.3, 0.3}}), blade_across(), Affine3d::Identity());
  ASSERT_FALSE(never);
  EXPECT_EQ(never.error().code(), StatusCode::empty_input);
}

TEST(SweepBlade, a_part_of_the_motion_at_a_place_in_the_world) {
  SweepOptions options;
  options.first_time = 0.25;
  options.last_time = 0.5;
  Affine3d place = Affine3d::Identity();
  place.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()).toRotationMatrix();
  place.translation() = Vec3d(1, 2, 3);
  const auto found = sweep_blade(motion_of(turn(2)), blade_across(), place, options);
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_EQ(found->times.front(), 0.25);
  EXPECT_EQ(found->times.back(), 0.5);
  const Vec3d first(2 * std::cos(0.5), 2 * std::sin(0.5), 0.1);
  EXPECT_LE((found->blades.front().base - place * first).norm(), 1e-12);
}

TEST(SweepBlade, wrong_blades_and_options_are_refused) {
  const RobotMotion motion = motion_of(turn(1));
  const auto code = [&](const MountedBlade& blade, const SweepOptions& options = {}) {
    return sweep_blade(motion, blade, Affine3d::Identity(), options).error().code();
  };
  EXPECT_EQ(code({3, {1, 0, 0}, {1, 0, 1}}), StatusCode::index_out_of_range);
  EXPECT_EQ(code({2, {1, 0, 0}, {1, 0, 0}}), StatusCode::invalid_argument);
  EXPECT_EQ(code({2, {1, 0, 0}, {1, 0, std::nan("")}}), StatusCode::non_finite_value);
  SweepOptions options;
  options.spacing = 0;
  EXPECT_EQ(code(blade_across(), options), StatusCode::invalid_argument);
  options = {};
  options.seconds = std::nan("");
  EXPECT_EQ(code(blade_across(), options), StatusCode::invalid_argument);
  options = {};
  options.maximum_blades = 100;
  EXPECT_EQ(code(blade_across(), options), StatusCode::limit_exceeded);
  options = {};
  options.first_time = 2;
  options.last_time = 1;
  EXPECT_EQ(code(blade_across(), options), StatusCode::invalid_argument);
}

TEST(TearOfSweep, the_clip_runs_along_or_stands_still) {
  const BladeSweep found = sweep(motion_of(turn(0.1)));
  const auto still = tear_of_sweep(found, ClipPose{"Bend", 0.5});
  ASSERT_TRUE(still);
  EXPECT_TRUE(still->pose_changes.empty());
  EXPECT_EQ(still->stroke, found.blades);
  const auto running = tear_of_sweep(found, ClipPose{"Bend", 0.5}, 2.0);
  ASSERT_TRUE(running);
  ASSERT_EQ(running->pose_changes.size(), found.blades.size() - 1);
  for (const TearOperation::PoseChange& change : running->pose_changes)
    EXPECT_DOUBLE_EQ(std::get<ClipPose>(change.pose).time, 0.5 + 2 * found.times[change.blade]);
  EXPECT_FALSE(tear_of_sweep(found, RestPose{}, 1.0));
  EXPECT_FALSE(tear_of_sweep(found, ClipPose{"Bend", 0.5}, -1.0));
  EXPECT_FALSE(tear_of_sweep({}, RestPose{}));
}

}  // namespace
}  // namespace sunder
