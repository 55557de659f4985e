#include "tools/plan/hand_file.h"

#include <cmath>

#include "tools/messages/printed.h"

namespace sunder::tools {
namespace {

struct HandJoint {
  const char* name;
  const char* type;
  const char* axis;
};
constexpr HandJoint kJoints[] = {
    {"x", "prismatic", "1 0 0"},       {"y", "prismatic", "0 1 0"},
    {"z", "prismatic", "0 0 1"},       {"turn_x", "continuous", "1 0 0"},
    {"turn_y", "continuous", "0 1 0"}, {"turn_z", "continuous", "0 0 1"}};
constexpr double kFarthest = 1000;  ///< Metres: URDF wants limits of slides.

/// Roll, pitch and yaw of a rotation, about fixed axes.
Vec3d fixed_angles(const Mat3d& turn) {
  const double pitch = std::atan2(-turn(2, 0), std::hypot(turn(0, 0), turn(1, 0)));
  if (std::hypot(turn(0, 0), turn(1, 0)) < 1e-9)  // roll and yaw turn about one axis
    return {0, pitch, std::atan2(-turn(0, 1), turn(1, 1))};
  return {std::atan2(turn(2, 1), turn(2, 2)), pitch, std::atan2(turn(1, 0), turn(0, 0))};
}

}  // namespace

std::string hand_urdf(const Affine3d& root_from_hand, double length) {
  const Vec3d angles = fixed_angles(root_from_hand.linear());
  const Vec3d place = root_from_hand.translation();
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"hand\">\n  <link name=\"world\"/>\n";
  text += "  <link name=\"place\"/>\n";
  for (const HandJoint& joint : kJoints)
    if (&joint != &kJoints[5]) text += printed("  <link name=\"moved_%s\"/>\n", joint.name);
  text += printed(
      "  <link name=\"blade\">\n    <visual><origin xyz=\"0 0 %.17g\"/><geometry><box "
      "size=\"%.17g %.17g %.17g\"/></geometry></visual>\n  </link>\n",
      length / 2, length / 40, length / 8, length);
  text += printed(
      "  <joint name=\"stand\" type=\"fixed\">\n    <parent link=\"world\"/><child "
      "link=\"place\"/>\n    <origin xyz=\"%.17g %.17g %.17g\" rpy=\"%.17g %.17g %.17g\"/>\n"
      "  </joint>\n",
      place.x(), place.y(), place.z(), angles.x(), angles.y(), angles.z());
  std::string parent = "place";
  for (const HandJoint& joint : kJoints) {
    const std::string child =
        &joint == &kJoints[5] ? std::string("blade") : std::string("moved_") + joint.name;
    text += printed(
        "  <joint name=\"%s\" type=\"%s\">\n    <parent link=\"%s\"/><child link=\"%s\"/><axis "
        "xyz=\"%s\"/>\n",
        joint.name, joint.type, parent.c_str(), child.c_str(), joint.axis);
    if (std::string(joint.type) == "prismatic")
      text += printed("    <limit lower=\"%g\" upper=\"%g\" velocity=\"0\" effort=\"0\"/>\n",
                      -kFarthest, kFarthest);
    text += "  </joint>\n";
    parent = child;
  }
  return text + "</robot>\n";
}

}  // namespace sunder::tools
