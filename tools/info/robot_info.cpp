#include "tools/info/robot_info.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "tools/messages/exit_code.h"
#include "tools/messages/printed.h"

namespace sunder::tools {
namespace {

/// Deeper links are not indented further.
constexpr std::size_t kMostIndents = 24;

const char* type_name(RobotJointType type) {
  switch (type) {
    case RobotJointType::fixed: return "fixed";
    case RobotJointType::revolute: return "revolute";
    case RobotJointType::continuous: return "continuous";
    case RobotJointType::prismatic: return "prismatic";
    case RobotJointType::planar: return "planar";
    case RobotJointType::floating: return "floating";
  }
  return "unknown";
}

/// Null where there is no limit, as JSON knows no infinity.
Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json vector_of(const Vec3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

Json joint_json(const Robot& robot, std::size_t index) {
  const RobotJoint& joint = robot.joints[index];
  const RobotLink& link = robot.links[index + 1];
  Json json = {{"name", joint.name},
               {"type", type_name(joint.type)},
               {"parent", robot.links[link.parent].name},
               {"child", link.name},
               {"origin", vector_of(joint.parent_from_joint.translation())}};
  if (joint.type != RobotJointType::fixed && joint.type != RobotJointType::floating)
    json["axis"] = vector_of(joint.axis);
  if (joint.type == RobotJointType::revolute || joint.type == RobotJointType::prismatic) {
    json["lower"] = number_or_null(joint.lower);
    json["upper"] = number_or_null(joint.upper);
  }
  if (joint.mimicked_joint != kNone)
    json["mimic"] = {
        {"joint", robot.joints[joint.mimicked_joint].name},
        {"driven_by",
         joint.first_value == kNone ? Json(nullptr) : Json(robot.values[joint.first_value].name)},
        {"multiplier", joint.multiplier},
        {"offset", joint.offset}};
  return json;
}

std::string motion_text(const Robot& robot, const RobotJoint& joint) {
  std::string text = type_name(joint.type);
  if (joint.type != RobotJointType::fixed && joint.type != RobotJointType::floating)
    text += printed(" (%.4g, %.4g, %.4g)", joint.axis.x(), joint.axis.y(), joint.axis.z());
  const char* const unit = joint.type == RobotJointType::prismatic ? "m" : "rad";
  if (std::isfinite(joint.lower) && std::isfinite(joint.upper))
    text += printed(", %.5g to %.5g %s", joint.lower, joint.upper, unit);
  if (joint.mimicked_joint != kNone) {
    text += ", mimics '" + robot.joints[joint.mimicked_joint].name + "'";
    if (joint.first_value == kNone)
      text += printed(", stands at %.5g", joint.offset);
    else
      text += printed(", %.5g * '%s' + %.5g", joint.multiplier,
                      robot.values[joint.first_value].name.c_str(), joint.offset);
  }
  return text;
}

}  // namespace

Json robot_json(const Robot& robot) {
  Json json = {{"name", robot.name},
               {"links", Json::array()},
               {"joints", Json::array()},
               {"values", Json::array()}};
  for (const RobotLink& link : robot.links)
    json["links"].push_back(
        {{"name", link.name},
         {"parent", link.parent == kNone ? Json(nullptr) : Json(robot.links[link.parent].name)}});
  for (std::size_t i = 0; i < robot.joints.size(); ++i)
    json["joints"].push_back(joint_json(robot, i));
  for (const RobotValue& value : robot.values)
    json["values"].push_back({{"name", value.name},
                              {"joint", robot.joints[value.joint].name},
                              {"lower", number_or_null(value.lower)},
                              {"upper", number_or_null(value.upper)},
                              {"rest", value.rest}});
  return json;
}

Json findings_json(std::span<const RobotFinding> findings) {
  Json json = Json::array();
  for (const RobotFinding& finding : findings)
    json.push_back({{"code", finding.code},
                    {"severity", robot_severity_name(finding.severity)},
                    {"place", finding.place},
                    {"line", finding.line == 0 ? Json(nullptr) : Json(finding.line)},
                    {"text", finding.text}});
  return json;
}

Lines robot_text(const Robot& robot) {
  Lines lines;
  lines.add(printed("robot      '%s': %zu links, %zu joints, %zu values", robot.name.c_str(),
                    robot.links.size(), robot.joints.size(), robot.values.size()));
  std::vector<std::size_t> depth;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const RobotLink& link = robot.links[i];
    depth.push_back(link.parent == kNone ? 0 : depth[link.parent] + 1);
    std::string line =
        "  " + std::string(2 * std::min(depth[i], kMostIndents), ' ') + "'" + link.name + "'";
    if (i > 0)
      line += "  by '" + robot.joints[i - 1].name + "', " + motion_text(robot, robot.joints[i - 1]);
    lines.add(line);
  }
  return lines;
}

Lines findings_text(std::span<const RobotFinding> findings) {
  Lines lines;
  for (const RobotFinding& finding : findings) {
    std::string line =
        printed("%-11s %s", std::string(robot_severity_name(finding.severity)).c_str(),
                std::string(finding.code).c_str());
    if (finding.line > 0) line += printed(", line %u", finding.line);
    if (!finding.place.empty()) line += ", " + finding.place;
    lines.add(line + ": " + with_option_names(finding.text));
  }
  return lines;
}

}  // namespace sunder::tools
