#include "support/models/random_robot.h"

#include <algorithm>
#include <cstdio>

namespace sunder::test {
namespace {

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string vector(Random& random, double most) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += (i == 0 ? "" : " ") + number(random.uniform(-most, most));
  return text;
}

/// Often one of the frame's axes, as in most files.
std::string axis(Random& random) {
  switch (random.index(8)) {
    case 0: return "1 0 0";
    case 1: return "0 -1 0";
    case 2: return "0 0 1";
    case 3: return "0 0 -1";
    default: break;
  }
  const Vec3d direction = random.direction();
  return number(direction.x()) + " " + number(direction.y()) + " " + number(direction.z());
}

}  // namespace

std::string random_urdf(Random& random, std::uint32_t link_count, double bushiness) {
  static constexpr const char* kTypes[] = {"revolute", "revolute", "continuous", "prismatic",
                                           "fixed",    "planar",   "floating"};
  std::string text = "<robot name=\"random\">\n";
  for (std::uint32_t i = 0; i < link_count; ++i)
    text += "<link name=\"link" + std::to_string(i) + "\"/>\n";
  std::vector<std::uint32_t> single;  // joints with one value, which others can mimic
  for (std::uint32_t i = 1; i < link_count; ++i) {
    const std::uint32_t parent = random.uniform(0, 1) < bushiness ? random.index(i) : i - 1;
    const std::string type = kTypes[random.index(7)];
    text += "<joint name=\"joint" + std::to_string(i) + "\" type=\"" + type + "\">";
    text += "<origin xyz=\"" + vector(random, 0.5) + "\" rpy=\"" + vector(random, 4) + "\"/>";
    text += "<parent link=\"link" + std::to_string(parent) + "\"/><child link=\"link" +
            std::to_string(i) + "\"/>";
    if (random.index(8) != 0) text += "<axis xyz=\"" + axis(random) + "\"/>";
    const bool has_one = type == "revolute" || type == "continuous" || type == "prismatic";
    if (type == "revolute" || type == "prismatic")
      text += "<limit lower=\"" + number(random.uniform(-3, 0.5)) + "\" upper=\"" +
              number(random.uniform(0.6, 3)) + "\" effort=\"1\" velocity=\"1\"/>";
    if (has_one && !single.empty() && random.index(3) == 0)
      text += "<mimic joint=\"joint" +
              std::to_string(single[random.index(static_cast<std::uint32_t>(single.size()))]) +
              "\" multiplier=\"" + number(random.uniform(-2, 2)) + "\" offset=\"" +
              number(random.uniform(-1, 1)) + "\"/>";
    if (has_one) single.push_back(i);
    text += "</joint>\n";
  }
  return text + "</robot>\n";
}

std::vector<double> random_values(Random& random, const Robot& robot) {
  std::vector<double> values;
  for (const RobotValue& value : robot.values)
    values.push_back(random.uniform(std::max(value.lower, -12.0), std::min(value.upper, 12.0)));
  return values;
}

}  // namespace sunder::test
