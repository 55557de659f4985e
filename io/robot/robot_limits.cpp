#include <sunder/robot/robot_limits.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

struct Range {
  double lower = 0, upper = 0;
};

/// The positions of a joint with one value, relative to that in the rest pose.
Range range_of(const Robot& robot, const RobotJoint& joint) {
  if (joint.first_value == kNone || joint.multiplier == 0) return {};
  const RobotValue& value = robot.values[joint.first_value];
  Range range = {joint.multiplier * (value.lower - value.rest),
                 joint.multiplier * (value.upper - value.rest)};
  if (range.lower > range.upper) std::swap(range.lower, range.upper);
  return range;
}

bool turns(const RobotJoint& joint) {
  return joint.type == RobotJointType::revolute || joint.type == RobotJointType::continuous;
}

/// A range of more than a turn is all turns.
Range turn_range(const Robot& robot, const RobotJoint& joint) {
  const Range range = range_of(robot, joint);
  return range.upper - range.lower < 2 * std::numbers::pi
             ? range
             : Range{-std::numbers::pi, std::numbers::pi};
}

void set_hinge(const Vec3d& axis, const Range& range, JointRange& joint) {
  joint.turn = JointRange::Turn::hinge;
  joint.axis = axis;
  joint.lower = range.lower;
  joint.upper = range.upper;
}

void set_slide(const Vec3d& axis, const Range& range, JointRange& joint) {
  if (!std::isfinite(range.lower) || !std::isfinite(range.upper)) {
    joint.slide_radius = std::numeric_limits<double>::infinity();
    return;
  }
  joint.slide_from = axis * range.lower;
  joint.slide_to = axis * range.upper;
}

JointRange joint_range_of(const Robot& robot, const RobotJoint& joint) {
  JointRange range;
  range.angle = 0.0;
  if (turns(joint)) {
    set_hinge(joint.axis, turn_range(robot, joint), range);
  } else if (joint.type == RobotJointType::prismatic) {
    set_slide(joint.axis, range_of(robot, joint), range);
  } else if (joint.first_value != kNone && joint.type == RobotJointType::planar) {
    set_hinge(joint.axis, {-std::numbers::pi, std::numbers::pi}, range);
    range.slide_radius = std::numeric_limits<double>::infinity();
  } else if (joint.first_value != kNone && joint.type == RobotJointType::floating) {
    range.angle = std::numbers::pi;
    range.slide_radius = std::numeric_limits<double>::infinity();
  }
  return range;
}

}  // namespace

Result<JointLimits> joint_limits_of(const Robot& robot) {
  return or_out_of_memory([&]() -> Result<JointLimits> {
    if (const Status status = validate_robot(robot); !status) return status;
    JointLimits limits;
    limits.of_bone.reserve(robot.links.size());
    limits.of_bone.emplace_back().angle = 0.0;  // the root link stands still
    for (const RobotJoint& joint : robot.joints)
      limits.of_bone.push_back(joint_range_of(robot, joint));
    return limits;
  });
}

Result<std::vector<JointLimit>> pose_limits_of(const Robot& robot) {
  return or_out_of_memory([&]() -> Result<std::vector<JointLimit>> {
    if (const Status status = validate_robot(robot); !status) return status;
    std::vector<JointLimit> limits;
    for (std::uint32_t i = 0; i < robot.joints.size(); ++i) {
      if (!turns(robot.joints[i])) continue;
      const Range range = turn_range(robot, robot.joints[i]);
      if (range.lower == range.upper) continue;
      limits.push_back({i + 1, robot.joints[i].axis, range.lower, range.upper});
    }
    return limits;
  });
}

}  // namespace sunder
