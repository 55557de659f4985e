// RobotKinematics against a plain evaluation by Eigen's angle-axis rotations, and what the
// functions on robots promise: limits, failures that change nothing, no allocation.

#include <sunder/robot/robot.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "io/robot/internal/planar_axes.h"
#include "support/machine/allocation_count.h"
#include "support/machine/random.h"

namespace sunder::test {
namespace {

Vec3d random_vector(Random& random, double most) {
  return {random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most)};
}

/// A tree of joints of all types; every fourth joint with one value mimics an earlier one.
Robot random_robot(Random& random, std::uint32_t joint_count) {
  Robot robot;
  robot.name = "random";
  robot.links.push_back({"link 0", kNone});
  std::vector<std::uint32_t> driving;
  for (std::uint32_t i = 0; i < joint_count; ++i) {
    RobotJoint joint;
    joint.name = "joint " + std::to_string(i);
    joint.type = static_cast<RobotJointType>(random.index(6));
    joint.axis = random.direction();
    joint.parent_from_joint.linear() =
        Eigen::AngleAxisd(random.uniform(-3, 3), random.direction()).toRotationMatrix();
    joint.parent_from_joint.translation() = random_vector(random, 0.5);
    const std::uint32_t count = value_count_of(joint.type);
    if (count == 1 && !driving.empty() && random.index(4) == 0) {
      joint.mimicked_joint = driving[random.index(static_cast<std::uint32_t>(driving.size()))];
      joint.first_value = robot.joints[joint.mimicked_joint].first_value;
      joint.multiplier = random.uniform(-2, 2);
      joint.offset = random.uniform(-1, 1);
    } else if (count > 0) {
      joint.first_value = static_cast<std::uint32_t>(robot.values.size());
      if (count == 1) driving.push_back(i);
      for (std::uint32_t k = 0; k < count; ++k)
        robot.values.push_back({joint.name + "." + std::to_string(k), i, -2.5, 2.5, 0.0});
    }
    robot.joints.push_back(joint);
    robot.links.push_back({"link " + std::to_string(i + 1),
                           random.index(static_cast<std::uint32_t>(robot.links.size()))});
  }
  return robot;
}

/// The motion of a joint as docs/robot.md defines it.
Affine3d motion_of(const RobotJoint& joint, const std::vector<double>& values) {
  Affine3d motion = Affine3d::Identity();
  if (joint.type == RobotJointType::fixed) return motion;
  const double* const own = values.data() + joint.first_value;
  const double position = joint.multiplier * own[0] + joint.offset;
  if (joint.type == RobotJointType::revolute || joint.type == RobotJointType::continuous) {
    motion.linear() = Eigen::AngleAxisd(position, joint.axis).toRotationMatrix();
  } else if (joint.type == RobotJointType::prismatic) {
    motion.translation() = position * joint.axis;
  } else if (joint.type == RobotJointType::planar) {
    const auto turn =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(joint.axis));
    motion.linear() = Eigen::AngleAxisd(own[2], joint.axis).toRotationMatrix();
    motion.translation() = turn * Eigen::Vector3d(own[0], own[1], 0);
  } else {
    motion.translation() = Vec3d(own[0], own[1], own[2]);
    motion.linear() = Quatd(own[6], own[3], own[4], own[5]).normalized().toRotationMatrix();
  }
  return motion;
}

std::vector<Affine3d> plain_evaluation(const Robot& robot, const std::vector<double>& values,
                                       const Affine3d& model_from_root) {
  std::vector<Affine3d> frames = {model_from_root};
  for (std::size_t i = 0; i < robot.joints.size(); ++i)
    frames.push_back(
        Affine3d(frames[robot.links[i + 1].parent] * robot.joints[i].parent_from_joint *
                 motion_of(robot.joints[i], values)));
  return frames;
}

double difference(const std::vector<Affine3d>& a, const std::vector<Affine3d>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, (a[i].matrix() - b[i].matrix()).cwiseAbs().maxCoeff());
  return largest;
}

Robot one_joint(RobotJointType type) {
  Robot robot;
  robot.name = "one";
  robot.links = {{"base", kNone}, {"arm", 0}};
  RobotJoint joint;
  joint.name = "elbow";
  joint.type = type;
  joint.axis = Vec3d(0, 0, 1);
  joint.first_value = 0;
  robot.joints = {joint};
  robot.values = {{"elbow", 0, -1.0, 2.0, 0.0}};
  return robot;
}

TEST(RobotKinematics, agrees_with_a_plain_evaluation_on_random_trees) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    const Robot robot = random_robot(random, 1 + random.index(40));
    const auto kinematics = RobotKinematics::create(robot);
    ASSERT_TRUE(kinematics) << kinematics.error().text();
    std::vector<double> values;
    for (std::size_t i = 0; i < robot.values.size(); ++i) values.push_back(random.uniform(-3, 3));
    Affine3d root = Affine3d::Identity();
    root.linear() = Eigen::AngleAxisd(random.uniform(-3, 3), random.direction()).matrix();
    root.translation() = random_vector(random, 2);
    std::vector<Affine3d> frames(robot.links.size());
    ASSERT_TRUE(kinematics->evaluate(values, frames, root));
    EXPECT_LT(difference(frames, plain_evaluation(robot, values, root)), 1e-12);
  }
}

TEST(RobotKinematics, allocates_nothing) {
  Random random(2);
  const Robot robot = random_robot(random, 100);
  const auto kinematics = RobotKinematics::create(robot);
  ASSERT_TRUE(kinematics);
  std::vector<double> values(robot.values.size(), 0.3);
  std::vector<Affine3d> frames(robot.links.size());
  Pose pose;
  ASSERT_TRUE(
      pose_of_links(robot, std::vector<Affine3d>(frames.size(), Affine3d::Identity()), pose));
  const std::uint64_t before = allocation_count();
  bool all = true;
  for (int i = 0; i < 100; ++i) {
    values[0] = 0.01 * i;
    all = all && kinematics->evaluate(values, frames) && clamp_to_limits(robot, values) &&
          check_limits(robot, values) && pose_of_links(robot, frames, pose);
  }
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(all);
}

TEST(RobotKinematics, a_quaternion_of_any_length_turns_and_zero_does_not) {
  Robot robot = one_joint(RobotJointType::floating);
  robot.values.clear();
  for (const char* const part : {"x", "y", "z", "qx", "qy", "qz", "qw"})
    robot.values.push_back({part, 0, -1e308, 1e308, 0.0});
  const auto kinematics = RobotKinematics::create(robot);
  ASSERT_TRUE(kinematics) << kinematics.error().text();
  std::vector<Affine3d> frames(2);
  const double half = std::sqrt(0.5);
  for (const double length : {1e-300, 1e-20, 1.0, 1e20, 1e300}) {
    const std::vector<double> values = {1, 2, 3, 0, 0, half * length, half * length};
    ASSERT_TRUE(kinematics->evaluate(values, frames));
    EXPECT_NEAR((frames[1] * Vec3d(1, 0, 0) - Vec3d(1, 3, 3)).norm(), 0, 1e-12) << length;
  }
  ASSERT_TRUE(kinematics->evaluate(std::vector<double>(7, 0.0), frames));
  EXPECT_EQ(frames[1].matrix(), Affine3d::Identity().matrix());
}

TEST(RobotKinematics, a_joint_without_a_value_stands_at_its_offset) {
  Robot robot = one_joint(RobotJointType::prismatic);
  robot.values.clear();
  robot.joints[0].first_value = kNone;
  robot.joints[0].offset = 0.25;
  const auto kinematics = RobotKinematics::create(robot);
  ASSERT_TRUE(kinematics) << kinematics.error().text();
  std::vector<Affine3d> frames(2);
  ASSERT_TRUE(kinematics->evaluate({}, frames));
  EXPECT_EQ(frames[1].translation().z(), 0.25);
}

TEST(RobotKinematics, refuses_wrong_sizes_and_numbers_and_writes_nothing_then) {
  const auto kinematics = RobotKinematics::create(one_joint(RobotJointType::revolute));
  ASSERT_TRUE(kinematics);
  Affine3d mark = Affine3d::Identity();
  mark.translation() = Vec3d(7, 7, 7);
  std::vector<Affine3d> frames(2, mark), few(1, mark);
  const std::vector<double> one = {0.5}, two = {0.5, 0.5};
  const std::vector<double> nan = {std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(kinematics->evaluate(two, frames).code(), StatusCode::size_mismatch);
  EXPECT_EQ(kinematics->evaluate(one, few).code(), StatusCode::size_mismatch);
  const Status status = kinematics->evaluate(nan, frames);
  EXPECT_EQ(status.code(), StatusCode::non_finite_value);
  EXPECT_EQ(status.index(), 0u);
  for (const Affine3d& frame : frames) EXPECT_EQ(frame.matrix(), mark.matrix());
}

TEST(RobotLimits, are_enforced_or_reported) {
  const Robot robot = one_joint(RobotJointType::revolute);
  std::vector<double> values = {2.5};
  const Status status = check_limits(robot, values);
  EXPECT_EQ(status.code(), StatusCode::invalid_argument);
  EXPECT_NE(status.text().find("'elbow' is 2.5; its limits are -1 and 2"), std::string::npos);
  const auto changed = clamp_to_limits(robot, values);
  ASSERT_TRUE(changed);
  EXPECT_EQ(*changed, 1u);
  EXPECT_EQ(values[0], 2.0);
  EXPECT_TRUE(check_limits(robot, values));
  EXPECT_EQ(*clamp_to_limits(robot, values), 0u);
  std::vector<double> none;
  EXPECT_FALSE(clamp_to_limits(robot, none));
  EXPECT_FALSE(check_limits(robot, none));
}

TEST(RobotPose, gives_the_frames_back) {
  Random random(3);
  const Robot robot = random_robot(random, 60);
  const auto kinematics = RobotKinematics::create(robot);
  ASSERT_TRUE(kinematics);
  std::vector<double> values;
  for (std::size_t i = 0; i < robot.values.size(); ++i) values.push_back(random.uniform(-3, 3));
  std::vector<Affine3d> frames(robot.links.size());
  ASSERT_TRUE(kinematics->evaluate(values, frames));
  Pose pose;
  ASSERT_TRUE(pose_of_links(robot, frames, pose));
  std::vector<Affine3d> again;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Affine3d own = Affine3d::Identity();
    own.linear() = pose.parent_from_bone[i].rotation.cast<double>().toRotationMatrix();
    own.translation() = pose.parent_from_bone[i].translation.cast<double>();
    const std::uint32_t parent = robot.links[i].parent;
    again.push_back(parent == kNone ? own : Affine3d(again[parent] * own));
  }
  EXPECT_LT(difference(frames, again), 1e-5);
}

TEST(RobotCheck, names_the_first_fault) {
  const auto code_of = [](const auto& change) {
    Robot robot = one_joint(RobotJointType::revolute);
    change(robot);
    EXPECT_FALSE(RobotKinematics::create(robot));
    return validate_robot(robot).code();
  };
  EXPECT_TRUE(validate_robot(one_joint(RobotJointType::revolute)));
  EXPECT_EQ(code_of([](Robot& r) { r.links.clear(); }), StatusCode::empty_input);
  EXPECT_EQ(code_of([](Robot& r) { r.joints.clear(); }), StatusCode::size_mismatch);
  EXPECT_EQ(code_of([](Robot& r) { r.links[1].parent = 1; }), StatusCode::not_a_tree);
  EXPECT_EQ(code_of([](Robot& r) { r.links[0].parent = 0; }), StatusCode::not_a_tree);
  EXPECT_EQ(code_of([](Robot& r) { r.links[1].name = "base"; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_of([](Robot& r) { r.joints[0].axis *= 2; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_of([](Robot& r) { r.joints[0].first_value = 1; }), StatusCode::index_out_of_range);
  EXPECT_EQ(code_of([](Robot& r) { r.joints[0].mimicked_joint = 5; }),
            StatusCode::index_out_of_range);
  EXPECT_EQ(code_of([](Robot& r) { r.joints[0].parent_from_joint.linear() *= -1; }),
            StatusCode::invalid_argument);
  EXPECT_EQ(code_of([](Robot& r) { r.values[0].rest = 9; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_of([](Robot& r) { r.values[0].joint = 9; }), StatusCode::index_out_of_range);
  EXPECT_EQ(code_of([](Robot& r) { r.joints[0].offset = std::nan(""); }),
            StatusCode::non_finite_value);
}

/// No exception leaves the API.
TEST(RobotLimits, there_are_no_rest_values_without_memory) {
  if (!FailingAllocations::are_possible()) GTEST_SKIP();
  Robot robot;
  robot.values.resize(2);
  std::vector<double> values;
  EXPECT_NO_THROW({
    const FailingAllocations failing(0);
    values = rest_values(robot);
  });
  EXPECT_TRUE(values.empty());
  EXPECT_EQ(rest_values(robot).size(), 2u);
}

TEST(PlanarAxes, are_right_handed_with_any_normal) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    Vec3d normal = random.direction();
    if (i < 6)
      normal = Vec3d(i == 0   ? 1
                     : i == 1 ? -1
                              : 0,
                     i == 2   ? 1
                     : i == 3 ? -1
                              : 0,
                     i == 4   ? 1
                     : i == 5 ? -1
                              : 0);
    const auto [x, y] = robot::planar_axes(normal);
    EXPECT_NEAR(x.norm(), 1, 1e-9);
    EXPECT_NEAR(x.dot(normal), 0, 1e-9);
    EXPECT_NEAR((x.cross(y) - normal).norm(), 0, 1e-9);
  }
}

}  // namespace
}  // namespace sunder::test
