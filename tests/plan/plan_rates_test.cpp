// Analytic rates of the blade, of its errors and of the costs of the fit, against differences.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/blade_errors.h"
#include "pipeline/plan/find_obstacles.h"
#include "pipeline/plan/joint_spline.h"
#include "pipeline/plan/spline_costs.h"
#include "pipeline/plan/timeline.h"
#include "support/machine/random.h"

namespace sunder {
namespace {

constexpr double kStep = 1e-6;
constexpr double kClose = 1e-7;  ///< Relative to the size of what is compared, and of one.

/// A chain of joints of all types but floating, two of which follow others, with a blade at its
/// end.
PlanTool random_tool(test::Random& random) {
  PlanTool tool;
  Robot& robot = tool.robot;
  robot.links = {{"root", kNone}};
  const RobotJointType types[] = {RobotJointType::revolute,  RobotJointType::planar,
                                  RobotJointType::prismatic, RobotJointType::continuous,
                                  RobotJointType::revolute,  RobotJointType::prismatic,
                                  RobotJointType::revolute};
  for (std::uint32_t i = 0; i < 7; ++i) {
    RobotJoint joint;
    joint.name = "joint" + std::to_string(i);
    joint.type = types[i];
    joint.axis = random.direction();
    joint.parent_from_joint.linear() =
        Eigen::AngleAxisd(random.uniform(-3, 3), Eigen::Vector3d(random.direction()))
            .toRotationMatrix();
    joint.parent_from_joint.translation() = 0.4 * random.direction();
    if (i == 5 || i == 6) {  // they follow the slide and the first turn
      joint.mimicked_joint = i == 5 ? 2 : 0;
      joint.first_value = robot.joints[joint.mimicked_joint].first_value;
      joint.multiplier = random.uniform(-2, 2);
      joint.offset = random.uniform(-1, 1);
    } else {
      joint.first_value = static_cast<std::uint32_t>(robot.values.size());
      const std::uint32_t count = value_count_of(joint.type);
      for (std::uint32_t k = 0; k < count; ++k)
        robot.values.push_back({joint.name + "." + std::to_string(k), i});
    }
    robot.links.push_back({"link" + std::to_string(i), i});
    robot.joints.push_back(joint);
  }
  tool.blade = {7, random.direction(), random.direction()};
  tool.world_from_root.translation() = random.direction();
  return tool;
}

plan::TargetSample random_sample(test::Random& random) {
  plan::TargetSample sample;
  sample.place = random.direction();
  sample.normal = random.direction();
  sample.handle = random.direction();
  sample.depth = random.uniform(-0.1, 0.1);
  sample.lift = random.uniform(0, 1);
  return sample;
}

plan::Values random_values(test::Random& random, std::size_t count) {
  plan::Values values(static_cast<Eigen::Index>(count));
  for (double& value : values) value = random.uniform(-2, 2);
  return values;
}

/// Ten knots of about two seconds.
std::vector<double> random_knots(test::Random& random) {
  std::vector<double> knots = {0};
  while (knots.size() < 10) knots.push_back(knots.back() + random.uniform(0.05, 0.4));
  return knots;
}

void expect_near(double found, double expected, const char* what) {
  EXPECT_NEAR(found, expected, kClose * (1 + std::abs(expected))) << what;
}

TEST(PlanRates, the_blade_moves_as_its_rates_say) {
  test::Random random(1);
  for (int i = 0; i < 20; ++i) {
    auto chain = plan::BladeChain::create(random_tool(random));
    ASSERT_TRUE(chain) << chain.error().text();
    ASSERT_EQ(chain->size(), 7u);  // 1 + 3 + 1 + 1 + 1
    const plan::Values values = random_values(random, chain->size());
    plan::BladePlace at, less, more;
    chain->place({values.data(), chain->size()}, at, true);
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      plan::Values moved = values;
      moved[k] = values[k] - kStep;
      chain->place({moved.data(), chain->size()}, less, false);
      moved[k] = values[k] + kStep;
      chain->place({moved.data(), chain->size()}, more, false);
      for (Eigen::Index c = 0; c < 3; ++c) {
        expect_near(at.base_rates(c, k), (more.base[c] - less.base[c]) / (2 * kStep), "base");
        expect_near(at.tip_rates(c, k), (more.tip[c] - less.tip[c]) / (2 * kStep), "tip");
      }
    }
  }
}

/// Compares all blocks of rates of a cost.
void check_cost(const ceres::CostFunction& cost, std::vector<plan::Values> control) {
  const int count = cost.num_residuals();
  std::vector<const double*> at;
  for (const plan::Values& of : control) at.push_back(of.data());
  std::vector<std::vector<double>> rates;
  std::vector<double*> rate_pointers;
  for (const int size : cost.parameter_block_sizes())
    rates.emplace_back(static_cast<std::size_t>(size * count));
  for (auto& of : rates) rate_pointers.push_back(of.data());
  std::vector<double> errors(static_cast<std::size_t>(count)), less = errors, more = errors;
  ASSERT_TRUE(cost.Evaluate(at.data(), errors.data(), rate_pointers.data()));
  for (std::size_t block = 0; block < control.size(); ++block)
    for (Eigen::Index k = 0; k < control[block].size(); ++k) {
      const double value = control[block][k];
      control[block][k] = value - kStep;
      ASSERT_TRUE(cost.Evaluate(at.data(), less.data(), nullptr));
      control[block][k] = value + kStep;
      ASSERT_TRUE(cost.Evaluate(at.data(), more.data(), nullptr));
      control[block][k] = value;
      for (std::size_t r = 0; r < errors.size(); ++r)
        expect_near(rates[block][r * static_cast<std::size_t>(control[block].size()) +
                                 static_cast<std::size_t>(k)],
                    (more[r] - less[r]) / (2 * kStep), "cost");
    }
}

TEST(PlanRates, errors_of_the_blade_at_control_points) {
  test::Random random(2);
  for (int i = 0; i < 20; ++i) {
    auto chain = plan::BladeChain::create(random_tool(random));
    ASSERT_TRUE(chain);
    const plan::TargetSample sample = random_sample(random);
    const auto of = plan::spline_weights(random.uniform(0, 2), random_knots(random));
    std::vector<plan::Values> control;
    for (int k = 0; k < 4; ++k) control.push_back(random_values(random, chain->size()));
    check_cost(plan::BladeCost(*chain, sample, {0.1, 0.3, 0.7}, of.weights), control);
  }
}

TEST(PlanRates, distances_of_links_from_places) {
  test::Random random(5);
  for (int i = 0; i < 30; ++i) {
    auto chain = plan::BladeChain::create(random_tool(random));
    ASSERT_TRUE(chain);
    BoneCollider shape{
        1 + random.index(7),
        {Collider::Sphere{0.2}, 0.3 * random.direction(), Quatd(0.5, 0.5, -0.5, 0.5)}};
    if (i % 3 == 1) shape.collider.shape = Collider::Capsule{0.1, 0.3};
    if (i % 3 == 2) shape.collider.shape = Collider::Box{Vec3d(0.1, 0.2, 0.3)};
    plan::NearPlace near;
    near.place = 2 * random.direction();
    if (i % 2 == 0) near.normal = random.direction();
    const auto of = plan::spline_weights(random.uniform(0, 2), random_knots(random));
    std::vector<plan::Values> control;
    for (int k = 0; k < 4; ++k) control.push_back(random_values(random, chain->size()));
    check_cost(plan::ClearanceCost(*chain, shape, near, 20, 0.7, of.weights), control);
    check_cost(plan::ClearanceCost(*chain, shape, near, -20, 0.7, of.weights), control);
  }
}

TEST(PlanRates, sums_of_control_points_and_their_excess) {
  test::Random random(3);
  for (int i = 0; i < 20; ++i) {
    std::vector<plan::Values> control;
    for (int k = 0; k < 3; ++k) control.push_back(random_values(random, 5));
    check_cost(plan::StencilCost({1, -2, 1}, random_values(random, 5), random_values(random, 5)),
               control);
    plan::Values bounds = random_values(random, 5).cwiseAbs();
    bounds[2] = std::numeric_limits<double>::infinity();
    check_cost(plan::ExcessCost({1, -2, 1}, bounds, 0.3), control);
  }
}

TEST(PlanRates, a_spline_has_two_continuous_derivatives_and_stays_within_its_control_points) {
  test::Random random(4);
  plan::JointSpline spline;
  spline.knots = random_knots(random);
  for (int k = 0; k < 12; ++k) spline.control.push_back(random_values(random, 2));
  // Control points of a derivative.
  const auto derivative = [&](std::size_t order, Eigen::Index value) {
    std::vector<double> of;
    for (std::size_t k = 0; k + order < spline.control.size(); ++k) {
      const std::vector<double> weights = plan::derivative_weights(spline.knots, order, k);
      of.push_back(0);
      for (std::size_t i = 0; i <= order; ++i)
        of.back() += weights[i] * spline.control[k + i][value];
    }
    return of;
  };
  const auto greatest = [](const std::vector<double>& of) {
    double most = 0;
    for (const double x : of) most = std::max(most, std::abs(x));
    return most;
  };
  for (Eigen::Index value = 0; value < 2; ++value) {
    const std::vector<double> second = derivative(2, value);
    const double h = 1e-4, jerk = greatest(derivative(3, value));
    for (std::size_t knot = 1; knot < spline.intervals(); ++knot)
      for (const double away : {-2 * h, 2 * h}) {
        const double t = spline.knots[knot] + away;
        const double by_differences =
            (spline.at(t + h)[value] - 2 * spline.at(t)[value] + spline.at(t - h)[value]) / (h * h);
        EXPECT_NEAR(by_differences, second[knot], 3 * h * jerk + 1e-5);
      }
    double low = 1e9, high = -1e9;
    for (const plan::Values& control : spline.control) {
      low = std::min(low, control[value]);
      high = std::max(high, control[value]);
    }
    const double rate = greatest(derivative(1, value));
    for (double t = 0; t + 1e-3 <= spline.duration(); t += 1e-3) {
      EXPECT_GE(spline.at(t)[value], low - 1e-12);
      EXPECT_LE(spline.at(t)[value], high + 1e-12);
      EXPECT_LE(std::abs(spline.at(t + 1e-3)[value] - spline.at(t)[value]) / 1e-3, rate + 1e-9);
    }
  }
}

TEST(PlanTimes, a_cut_has_its_knots_however_long_the_approach_is) {
  test::Random random(6);
  for (int i = 0; i < 200; ++i) {
    PlanTiming timing;
    timing.approach = std::pow(10, random.uniform(-3, 3.5));
    timing.cut = std::pow(10, random.uniform(-3, 3.5));
    timing.retreat = std::pow(10, random.uniform(-3, 3.5));
    const plan::Timeline timeline(timing);
    const std::vector<double> knots = timeline.knots();
    EXPECT_EQ(knots.front(), 0);
    EXPECT_EQ(knots.back(), timeline.end());
    EXPECT_LE(knots.size(), 48u + 2 * 56u + 1);
    std::size_t in_cut = 0;
    for (std::size_t k = 1; k < knots.size(); ++k) {
      const double step = knots[k] - knots[k - 1];
      ASSERT_GT(step, 0);
      const double middle = 0.5 * (knots[k] + knots[k - 1]);
      if (middle < timeline.cut_begins() || middle > timeline.cut_ends()) continue;
      ++in_cut;
      EXPECT_NEAR(step, timing.cut / 48, 1e-9 * timeline.end());
    }
    EXPECT_EQ(in_cut, 48u);
  }
}

TEST(PlanTimes, a_motion_without_samples_in_the_cut_is_not_reached) {
  test::Random random(8);
  auto chain = plan::BladeChain::create(random_tool(random));
  ASSERT_TRUE(chain);
  std::vector<plan::TargetSample> samples(3, random_sample(random));
  for (plan::TargetSample& sample : samples) sample.depth = -0.1;
  const std::vector<plan::Values> values(3, random_values(random, chain->size()));
  const plan::ReachedPart part = plan::reached_part(*chain, samples, values, 1);
  EXPECT_FALSE(part.is_whole);
  EXPECT_EQ(part.first, part.end);
}

}  // namespace
}  // namespace sunder
