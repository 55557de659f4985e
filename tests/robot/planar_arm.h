#pragma once

#include <sunder/robot/trajectory.h>

#include <cmath>
#include <numbers>

namespace sunder::test {

/// An arm of two links of one metre that turn about z: "shoulder" at the origin, "elbow" at the end
/// of the first. Link 2 is the forearm, whose end is (1, 0, 0) in its frame.
inline Robot make_planar_arm() {
  Robot robot;
  robot.name = "planar arm";
  robot.links = {{"base", kNone}, {"upper", 0}, {"fore", 1}};
  for (const char* const name : {"shoulder", "elbow"}) {
    RobotJoint joint;
    joint.name = name;
    joint.type = RobotJointType::revolute;
    joint.axis = Vec3d::UnitZ();
    joint.first_value = static_cast<std::uint32_t>(robot.values.size());
    joint.lower = -std::numbers::pi;
    joint.upper = std::numbers::pi;
    if (!robot.joints.empty()) joint.parent_from_joint.translation() = Vec3d(1, 0, 0);
    robot.values.push_back(
        {name, static_cast<std::uint32_t>(robot.joints.size()), joint.lower, joint.upper, 0.0});
    robot.joints.push_back(joint);
  }
  return robot;
}

/// A blade at the end of the forearm, across the plane of the arm, 10 cm to both sides.
inline MountedBlade blade_across() { return {2, {1, 0, 0.1}, {1, 0, -0.1}}; }

/// The angles that put the end of the forearm at (x, y).
inline std::array<double, 2> reach(double x, double y) {
  const double squared = x * x + y * y;
  const double elbow = std::acos((squared - 2) / 2);
  return {std::atan2(y, x) - std::atan2(std::sin(elbow), 1 + std::cos(elbow)), elbow};
}

/// The end of the forearm follows a line from `a` to `b` within a second.
inline RobotTrajectory line(const Vec2d& a, const Vec2d& b, std::uint32_t steps) {
  RobotTrajectory trajectory;
  trajectory.names = {"shoulder", "elbow"};
  for (std::uint32_t i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const Vec2d at = a + share * (b - a);
    trajectory.times.push_back(share);
    for (const double angle : reach(at.x(), at.y())) trajectory.values.push_back(angle);
  }
  return trajectory;
}

}  // namespace sunder::test
