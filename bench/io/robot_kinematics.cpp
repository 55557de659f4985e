#include "bench/io/robot_kinematics.h"

#include <sunder/io/robot_file.h>
#include <sunder/robot/robot.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

namespace sunder::bench {
namespace {

constexpr int kRuns = 30, kPosesPerRun = 2000, kPoses = 64;

Robot chain_robot() {
  Robot robot;
  robot.name = "chain of 40";
  robot.links.push_back({"link 0", kNone});
  for (std::uint32_t i = 0; i < 40; ++i) {
    RobotJoint joint;
    joint.name = "joint " + std::to_string(i);
    joint.type = RobotJointType::revolute;
    joint.axis = i % 2 == 0 ? Vec3d(0, 0, 1) : Vec3d(0, 0.6, 0.8);
    joint.parent_from_joint.linear() =
        Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).toRotationMatrix();
    joint.parent_from_joint.translation() = Vec3d(0, 0, 0.1);
    joint.first_value = i;
    joint.lower = -3;
    joint.upper = 3;
    robot.joints.push_back(joint);
    robot.links.push_back({"link " + std::to_string(i + 1), i});
    robot.values.push_back({joint.name, i, -3, 3, 0});
  }
  return robot;
}

/// Values that differ from pose to pose, so that no branch or angle is the same each time.
std::vector<std::vector<double>> poses_of(const Robot& robot) {
  std::vector<std::vector<double>> poses(kPoses);
  for (int pose = 0; pose < kPoses; ++pose)
    for (std::size_t i = 0; i < robot.values.size(); ++i) {
      const double share =
          static_cast<double>((i * 37 + static_cast<std::size_t>(pose) * 11) % 64) / 63;
      const double lower = std::max(robot.values[i].lower, -3.0);
      const double upper = std::min(robot.values[i].upper, 3.0);
      poses[static_cast<std::size_t>(pose)].push_back(lower + share * (upper - lower));
    }
  return poses;
}

Result<KinematicsTime> time_kinematics(const Robot& robot) {
  const Result<RobotKinematics> kinematics = RobotKinematics::create(robot);
  if (!kinematics) return kinematics.error();
  const std::vector<std::vector<double>> poses = poses_of(robot);
  std::vector<Affine3d> frames(robot.links.size());
  double best = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kRuns; ++run) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kPosesPerRun; ++i)
      if (const Status status =
              kinematics->evaluate(poses[static_cast<std::size_t>(i % kPoses)], frames);
          !status)
        return status;
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    best = std::min(best, time.count() / kPosesPerRun);
  }
  KinematicsTime result;
  result.robot = robot.name;
  result.joints = static_cast<std::uint32_t>(robot.joints.size());
  for (const RobotJoint& joint : robot.joints)
    if (joint.first_value != kNone) ++result.moving_joints;
  result.ns_per_joint = best / std::max<std::uint32_t>(1, result.joints);
  result.ns_per_moving_joint = best / std::max<std::uint32_t>(1, result.moving_joints);
  return result;
}

}  // namespace

Result<KinematicsTime> time_chain() { return time_kinematics(chain_robot()); }

Result<KinematicsTime> time_robot(const std::filesystem::path& urdf) {
  RobotLoadOptions options;
  options.shapes = RobotShapes::none;
  const Result<LoadedRobot> loaded = load_robot(urdf, options);
  if (!loaded) return loaded.error();
  return time_kinematics(loaded->robot);
}

}  // namespace sunder::bench
