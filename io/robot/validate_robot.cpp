#include <sunder/robot/robot.h>

#include <cmath>
#include <string_view>
#include <unordered_set>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

Status invalid(std::uint32_t index, const char* kind, const std::string& name, const char* text) {
  return Status::failure(StatusCode::invalid_argument, index, "%s %u '%.80s': %s", kind, index,
                         name.c_str(), text);
}

/// One kind of the robot's parts, each with a name of its own.
template <class Part>
Status check_names(const std::vector<Part>& parts, const char* kind) {
  std::unordered_set<std::string_view> names;
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    if (parts[i].name.empty()) return invalid(i, kind, parts[i].name, "it has no name");
    if (!names.insert(parts[i].name).second)
      return invalid(i, kind, parts[i].name, "an earlier one has the same name");
  }
  return {};
}

Status check_links(const Robot& robot) {
  if (robot.links.empty())
    return Status::failure(StatusCode::empty_input, kNone, "the robot has no link");
  if (robot.joints.size() + 1 != robot.links.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "%zu joints for %zu links; expected one less than links",
                           robot.joints.size(), robot.links.size());
  if (robot.links[0].parent != kNone)
    return Status::failure(StatusCode::not_a_tree, 0, "link 0 is the root and has no parent");
  for (std::uint32_t i = 1; i < robot.links.size(); ++i)
    if (robot.links[i].parent >= i)
      return Status::failure(StatusCode::not_a_tree, i,
                             "link %u '%.80s': its parent must have a lower index", i,
                             robot.links[i].name.c_str());
  return {};
}

bool is_rotation(const Mat3d& matrix) {
  const Mat3d product = multiply(Mat3d(matrix.transpose()), matrix);
  return (product - Mat3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 &&
         dot(Vec3d(matrix.col(0)), Vec3d(Vec3d(matrix.col(1)).cross(Vec3d(matrix.col(2))))) > 0;
}

bool is_finite(const RobotJoint& joint) {
  return joint.parent_from_joint.matrix().allFinite() && joint.axis.allFinite() &&
         std::isfinite(joint.multiplier) && std::isfinite(joint.offset) &&
         !std::isnan(joint.lower) && !std::isnan(joint.upper) && std::isfinite(joint.velocity) &&
         std::isfinite(joint.effort);
}

/// Whether the values from first_value belong to the joint, or to the joint with one value that
/// drives it.
Status check_values_of(const Robot& robot, std::uint32_t index) {
  const RobotJoint& joint = robot.joints[index];
  if (joint.first_value == kNone) return {};
  const bool is_driven = joint.mimicked_joint != kNone;
  const std::uint32_t count = is_driven ? 1 : value_count_of(joint.type);
  if (count == 0) return invalid(index, "joint", joint.name, "a fixed joint has no value");
  if (is_driven && value_count_of(joint.type) != 1)
    return invalid(index, "joint", joint.name, "a joint of its type cannot mimic another one");
  if (joint.first_value >= robot.values.size() || count > robot.values.size() - joint.first_value)
    return Status::failure(StatusCode::index_out_of_range, index,
                           "joint %u '%.80s': value %u does not exist; the robot has %zu", index,
                           joint.name.c_str(), joint.first_value, robot.values.size());
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t owner = robot.values[joint.first_value + k].joint;
    if (is_driven ? owner >= robot.joints.size() || value_count_of(robot.joints[owner].type) != 1
                  : owner != index)
      return invalid(index, "joint", joint.name, "its value belongs to another joint");
  }
  return {};
}

Status check_joint(const Robot& robot, std::uint32_t index) {
  const RobotJoint& joint = robot.joints[index];
  if (!is_finite(joint))
    return Status::failure(StatusCode::non_finite_value, index,
                           "joint %u '%.80s' has a number that is not finite", index,
                           joint.name.c_str());
  if (std::abs(norm(joint.axis) - 1.0) > 1e-6)
    return invalid(index, "joint", joint.name, "its axis does not have unit length");
  if (!is_rotation(joint.parent_from_joint.linear()))
    return invalid(index, "joint", joint.name, "parent_from_joint is not a rotation");
  if (joint.mimicked_joint != kNone && joint.mimicked_joint >= robot.joints.size())
    return Status::failure(StatusCode::index_out_of_range, index,
                           "joint %u '%.80s' mimics joint %u; the robot has %zu", index,
                           joint.name.c_str(), joint.mimicked_joint, robot.joints.size());
  return check_values_of(robot, index);
}

Status check_value(const RobotValue& value, std::uint32_t index, std::size_t joint_count) {
  if (value.joint >= joint_count)
    return Status::failure(StatusCode::index_out_of_range, index,
                           "value %u '%.80s': joint %u does not exist; the robot has %zu", index,
                           value.name.c_str(), value.joint, joint_count);
  if (std::isnan(value.lower) || std::isnan(value.upper) || !std::isfinite(value.rest))
    return Status::failure(StatusCode::non_finite_value, index,
                           "value %u '%.80s' has a number that is not finite", index,
                           value.name.c_str());
  if (!(value.lower <= value.rest && value.rest <= value.upper))
    return invalid(index, "value", value.name, "rest is not between its limits");
  return {};
}

Status check(const Robot& robot) {
  if (const Status status = check_links(robot); !status) return status;
  if (const Status status = check_names(robot.links, "link"); !status) return status;
  if (const Status status = check_names(robot.joints, "joint"); !status) return status;
  if (const Status status = check_names(robot.values, "value"); !status) return status;
  for (std::uint32_t i = 0; i < robot.values.size(); ++i)
    if (const Status status = check_value(robot.values[i], i, robot.joints.size()); !status)
      return status;
  for (std::uint32_t i = 0; i < robot.joints.size(); ++i)
    if (const Status status = check_joint(robot, i); !status) return status;
  return {};
}

}  // namespace

Status validate_robot(const Robot& robot) {
  return or_out_of_memory([&] { return check(robot); });
}

}  // namespace sunder
