#include "io/urdf/make_robot.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "io/urdf/joint_checks.h"

namespace sunder::urdf {
namespace {

constexpr std::array<const char*, 3> kPlanarParts = {"x", "y", "angle"};
constexpr std::array<const char*, 7> kFloatingParts = {"x", "y", "z", "qx", "qy", "qz", "qw"};

class RobotMaker {
 public:
  RobotMaker(const RobotTags& tags, const ParsedRobot& parsed, const LinkTree& tree,
             const std::vector<MimicChain>& chains)
      : tags_(tags), parsed_(parsed), tree_(tree), chains_(chains) {}

  Robot make() {
    robot_.name = tags_.name;
    for (std::size_t i = 0; i < tree_.links.size(); ++i)
      robot_.links.push_back({tags_.links[tree_.links[i]].name, tree_.parents[i]});
    place_of_.assign(tags_.joints.size(), kNone);
    for (std::uint32_t i = 0; i < tree_.joints.size(); ++i) place_of_[tree_.joints[i]] = i;
    for (const std::uint32_t joint : tree_.joints) robot_.joints.push_back(joint_of(joint));
    add_values();
    connect_mimics();
    return std::move(robot_);
  }

 private:
  [[nodiscard]] RobotJoint joint_of(std::uint32_t index) const {
    const JointTag& tag = tags_.joints[index];
    const ParsedRobot::Joint& parsed = parsed_.joints[index];
    RobotJoint joint;
    joint.name = tag.name;
    joint.type = *joint_type_named(tag.type);
    joint.parent_from_joint = parsed.parent_from_joint;
    joint.axis = parsed.axis;
    const bool has_limits = joint.type == RobotJointType::revolute ||
                            (joint.type == RobotJointType::prismatic && tag.limit.has_value());
    if (has_limits) {
      joint.lower = parsed.lower;
      joint.upper = parsed.upper;
    }
    joint.velocity = parsed.velocity;
    joint.effort = parsed.effort;
    return joint;
  }

  void add_values() {
    // Only values of joints with several can have a name that another joint has already.
    std::set<std::string> taken;
    for (const RobotJoint& joint : robot_.joints) taken.insert(joint.name);
    for (std::uint32_t i = 0; i < robot_.joints.size(); ++i) {
      RobotJoint& joint = robot_.joints[i];
      const std::uint32_t count = value_count_of(joint.type);
      if (count == 0 || chains_[tree_.joints[i]].mimicked != kNone) continue;
      joint.first_value = static_cast<std::uint32_t>(robot_.values.size());
      for (std::uint32_t part = 0; part < count; ++part) robot_.values.push_back(value_of(i, part));
      if (count == 1) continue;
      for (std::uint32_t part = 0; part < count; ++part) {
        RobotValue& value = robot_.values[joint.first_value + part];
        value.name += std::string(".") + (count == 3 ? kPlanarParts[part] : kFloatingParts[part]);
        while (!taken.insert(value.name).second) value.name += "_";
      }
    }
  }

  [[nodiscard]] RobotValue value_of(std::uint32_t index, std::uint32_t part) const {
    const RobotJoint& joint = robot_.joints[index];
    RobotValue value;
    value.name = joint.name;
    value.joint = index;
    value.lower = joint.lower;
    value.upper = joint.upper;
    value.rest = std::clamp(0.0, value.lower, value.upper);
    if (joint.type == RobotJointType::floating && part == 6) value.rest = 1.0;
    return value;
  }

  void connect_mimics() {
    for (std::uint32_t i = 0; i < robot_.joints.size(); ++i) {
      const MimicChain& chain = chains_[tree_.joints[i]];
      if (chain.mimicked == kNone) continue;
      RobotJoint& joint = robot_.joints[i];
      joint.mimicked_joint = place_of_[chain.mimicked];
      joint.multiplier = chain.multiplier;
      joint.offset = chain.offset;
      if (chain.driving != kNone)
        joint.first_value = robot_.joints[place_of_[chain.driving]].first_value;
    }
  }

  const RobotTags& tags_;
  const ParsedRobot& parsed_;
  const LinkTree& tree_;
  const std::vector<MimicChain>& chains_;
  Robot robot_;
  std::vector<std::uint32_t> place_of_;  ///< In the robot, per joint of the tags.
};

}  // namespace

Robot make_robot(const RobotTags& tags, const ParsedRobot& parsed, const LinkTree& tree,
                 const std::vector<MimicChain>& chains) {
  return RobotMaker(tags, parsed, tree, chains).make();
}

}  // namespace sunder::urdf
