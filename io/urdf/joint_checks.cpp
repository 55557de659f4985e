#include "io/urdf/joint_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace sunder::urdf {
namespace {

/// Axes are often written with three or four digits.
constexpr double kUnitTolerance = 1e-3;

constexpr std::array<std::pair<std::string_view, RobotJointType>, 6> kTypes = {
    {{"fixed", RobotJointType::fixed},
     {"revolute", RobotJointType::revolute},
     {"continuous", RobotJointType::continuous},
     {"prismatic", RobotJointType::prismatic},
     {"planar", RobotJointType::planar},
     {"floating", RobotJointType::floating}}};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

/// Scaled first, so that squares neither vanish nor overflow.
double length_of(const Numbers3& vector) {
  double largest = 0, square = 0;
  for (const double part : vector) largest = std::max(largest, std::abs(part));
  if (largest == 0) return 0;
  for (const double part : vector) square += (part / largest) * (part / largest);
  return largest * std::sqrt(square);
}

void repair_axis(JointTag& joint, Findings& findings) {
  if (!joint.axis) return;
  Numbers3& axis = *joint.axis;
  const double length = length_of(axis);
  if (!(length > 0) || !std::isfinite(length)) {
    findings.add("axis_zero", place_of(joint),
                 "its axis has no length, so it is not known how it moves");
    return;
  }
  if (std::abs(length - 1.0) > kUnitTolerance)
    findings.add("axis_not_unit", place_of(joint),
                 "its axis has the length " + number(length) + " and was normalised");
  for (double& part : axis) part /= length;
}

void repair_limits(JointTag& joint, bool is_revolute, Findings& findings) {
  if (!joint.limit) {
    findings.add("limits_missing", place_of(joint),
                 is_revolute ? "it is revolute but has no <limit>; taken as continuous"
                             : "it is prismatic but has no <limit>; taken as unlimited");
    if (is_revolute) joint.type = "continuous";
    return;
  }
  LimitTag& limit = *joint.limit;
  limit.lower = limit.lower.value_or(0.0);
  limit.upper = limit.upper.value_or(0.0);
  if (*limit.lower > *limit.upper) {
    findings.add("limits_inverted", place_of(joint),
                 "its lower limit " + number(*limit.lower) + " is above its upper limit " +
                     number(*limit.upper) + "; they were exchanged");
    std::swap(*limit.lower, *limit.upper);
  }
  if (*limit.lower == 0 && *limit.upper == 0)
    findings.add("limits_zero", place_of(joint),
                 "its lower and upper limit are 0, so it cannot move");
}

/// Bones are in single precision: where a link rests has to be within its range.
void check_range(const JointTag& joint, Findings& findings) {
  double farthest = 0;
  for (const double part : joint.origin.xyz) farthest = std::max(farthest, std::abs(part));
  if (joint.type == "prismatic" && joint.limit)
    farthest += std::abs(std::clamp(0.0, *joint.limit->lower, *joint.limit->upper));
  if (farthest > std::numeric_limits<float>::max())
    findings.add("number_not_finite", place_of(joint),
                 "its link rests " + number(farthest) +
                     " m away, which is beyond the range of single precision");
}

void repair_joint(JointTag& joint, Findings& findings) {
  const std::optional<RobotJointType> type = joint_type_named(joint.type);
  if (!type) {
    findings.add("joint_type_unknown", place_of(joint),
                 "its type '" + joint.type.substr(0, 40) +
                     "' is none of fixed, revolute, continuous, prismatic, planar and floating");
    return;
  }
  if (*type == RobotJointType::fixed || *type == RobotJointType::floating)
    joint.axis.reset();
  else
    repair_axis(joint, findings);
  if (*type == RobotJointType::revolute || *type == RobotJointType::prismatic)
    repair_limits(joint, *type == RobotJointType::revolute, findings);
  else if (joint.limit &&
           (joint.limit->lower.value_or(0) != 0 || joint.limit->upper.value_or(0) != 0))
    findings.add("limits_ignored", place_of(joint),
                 "a " + joint.type + " joint has no lower and upper limit; they are ignored");
  check_range(joint, findings);
}

}  // namespace

std::optional<RobotJointType> joint_type_named(std::string_view name) {
  for (const auto& [of, type] : kTypes)
    if (of == name) return type;
  return std::nullopt;
}

void repair_joints(RobotTags& tags, Findings& findings) {
  for (JointTag& joint : tags.joints) repair_joint(joint, findings);
}

}  // namespace sunder::urdf
