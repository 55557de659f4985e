#include "io/urdf/canonical_text.h"

#include <charconv>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>

namespace sunder::urdf {
namespace {

/// Shortest text that keeps the bits, whatever the locale.
std::string numbers(std::span<const double> values) {
  std::string text;
  for (const double value : values) {
    char digits[64];
    const char* const end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    if (!text.empty()) text += ' ';
    text.append(digits, static_cast<std::size_t>(end - digits));
  }
  return text;
}

std::string shortest_number(double value) { return numbers({&value, 1}); }

void append_origin(std::string& text, const OriginTag& origin) {
  text += "<origin xyz=\"" + numbers(origin.xyz) + "\" rpy=\"" + numbers(origin.rpy) + "\"/>";
}

/// The sizes are not needed; every shape stands for its origin.
void append_shapes(std::string& text, const char* tag, const std::vector<ShapeTag>& shapes) {
  for (const ShapeTag& shape : shapes) {
    text += std::string("<") + tag + ">";
    append_origin(text, shape.origin);
    text += std::string("<geometry><sphere radius=\"1\"/></geometry></") + tag + ">\n";
  }
}

void append_joint(std::string& text, const JointTag& joint, std::uint32_t index,
                  const std::map<std::string_view, std::uint32_t>& link_of_name) {
  const auto link = [&](const std::string& name) {
    return "l" + std::to_string(link_of_name.at(name));
  };
  text += "<joint name=\"j" + std::to_string(index) + "\" type=\"" + joint.type + "\">";
  append_origin(text, joint.origin);
  text +=
      "<parent link=\"" + link(joint.parent) + "\"/><child link=\"" + link(joint.child) + "\"/>";
  if (joint.axis) text += "<axis xyz=\"" + numbers(*joint.axis) + "\"/>";
  // urdfdom requires limits where Sunder does not; they are not used then.
  const LimitTag limit = joint.limit.value_or(LimitTag{});
  text += "<limit lower=\"" + shortest_number(limit.lower.value_or(0)) + "\" upper=\"" +
          shortest_number(limit.upper.value_or(0)) + "\" effort=\"" +
          shortest_number(limit.effort) + "\" velocity=\"" + shortest_number(limit.velocity) +
          "\"/>";
  text += "</joint>\n";
}

}  // namespace

std::string canonical_text(const RobotTags& tags) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"robot\">\n";
  std::map<std::string_view, std::uint32_t> link_of_name;
  for (std::uint32_t i = 0; i < tags.links.size(); ++i) {
    link_of_name.try_emplace(tags.links[i].name, i);
    text += "<link name=\"l" + std::to_string(i) + "\">\n";
    append_shapes(text, "visual", tags.links[i].visuals);
    append_shapes(text, "collision", tags.links[i].collisions);
    text += "</link>\n";
  }
  for (std::uint32_t i = 0; i < tags.joints.size(); ++i)
    append_joint(text, tags.joints[i], i, link_of_name);
  return text + "</robot>\n";
}

}  // namespace sunder::urdf
