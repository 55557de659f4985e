#include "io/urdf/read_tags.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <tinyxml2.h>
#include <vector>

#include "io/urdf/ignored_tags.h"
#include "io/urdf/numbers.h"

namespace sunder::urdf {
namespace {

using tinyxml2::XMLElement;

std::uint32_t line_of(const XMLElement& tag) {
  return static_cast<std::uint32_t>(std::max(tag.GetLineNum(), 0));
}

std::string attribute_of(const XMLElement& tag, const char* name) {
  const char* const value = tag.Attribute(name);
  return value == nullptr ? std::string() : std::string(value);
}

/// Parts of a joint that Sunder uses.
bool is_single_part(std::string_view name) {
  return name == "origin" || name == "parent" || name == "child" || name == "axis" ||
         name == "limit" || name == "mimic";
}

/// A person's words for what tinyxml2 says by a constant.
std::string words_of(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "a tag is closed by one of another name, or not at all";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT: return "a tag is malformed";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute is malformed, or is twice in one tag";
    case tinyxml2::XML_ERROR_PARSING_TEXT: return "a text is not followed by a tag";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION:
      return "<?...?> is not at the beginning of the file";
    case tinyxml2::XML_ERROR_PARSING: return "a tag is never closed; is the file cut off?";
    default: return tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID());
  }
}

class TagReader {
 public:
  explicit TagReader(Findings& findings) : findings_(findings), ignored_(findings) {}

  RobotTags read(const XMLElement& root) {
    RobotTags tags;
    tags.name = attribute_of(root, "name");
    find_xacro(root);
    for (const XMLElement* tag = root.FirstChildElement(); tag; tag = tag->NextSiblingElement()) {
      const std::string_view name = tag->Name();
      if (name == "link")
        tags.links.push_back(read_link(*tag));
      else if (name == "joint")
        tags.joints.push_back(read_joint(*tag));
      else if (name == "material")
        tags.materials.push_back(read_material(*tag, {}));
      else
        ignored_.add("robot", *tag);
    }
    ignored_.finish();
    return tags;
  }

 private:
  // ---- Numbers

  bool numbers(const XMLElement& tag, const char* attribute, const Place& place,
               std::span<double> into) {
    const char* const text = tag.Attribute(attribute);
    return text != nullptr &&
           read_numbers(text, attribute, {place.name, line_of(tag)}, into, findings_);
  }

  /// As numbers(), of an attribute that has to be there.
  void required(const XMLElement& tag, const char* attribute, const Place& place,
                std::span<double> into) {
    if (tag.Attribute(attribute) == nullptr)
      findings_.add("number_malformed", {place.name, line_of(tag)},
                    "<" + std::string(tag.Name()) + "> has no " + attribute);
    else
      numbers(tag, attribute, place, into);
  }

  /// A second tag of this name beside an earlier one, where one is enough. As for urdfdom, the
  /// first one counts. Linear in all: the search ends at the nearest tag of the name.
  bool is_repeated(const XMLElement& tag, const Place& place) {
    if (tag.PreviousSiblingElement(tag.Name()) == nullptr) return false;
    findings_.add("tag_repeated", {place.name, line_of(tag)},
                  "it has another <" + std::string(tag.Name()) + ">; the first one counts");
    return true;
  }

  // ---- Links

  LinkTag read_link(const XMLElement& tag) {
    LinkTag link;
    link.name = attribute_of(tag, "name");
    link.line = line_of(tag);
    const Place place = place_of(link);
    for (const XMLElement* child = tag.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      const std::string_view name = child->Name();
      if (name == "visual")
        read_shape(*child, place, link.visuals);
      else if (name == "collision")
        read_shape(*child, place, link.collisions);
      else if (name != "inertial")
        ignored_.add("link", *child);
    }
    return link;
  }

  void read_shape(const XMLElement& tag, const Place& link, std::vector<ShapeTag>& shapes) {
    ShapeTag shape;
    shape.line = line_of(tag);
    const Place place = {link.name, shape.line};
    bool has_geometry = false, is_known = false;
    for (const XMLElement* child = tag.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      const std::string_view name = child->Name();
      if (name == "origin" || name == "geometry" || name == "material")
        if (is_repeated(*child, place)) continue;
      if (name == "origin") {
        shape.origin = read_origin(*child, place);
      } else if (name == "geometry") {
        has_geometry = has_geometry || child->FirstChildElement() != nullptr;
        is_known = read_geometry(*child, place, shape) || is_known;
      } else if (name == "material") {
        shape.material = read_material(*child, place);
      } else {
        ignored_.add(tag.Name(), *child);
      }
    }
    if (is_known) shapes.push_back(std::move(shape));
    if (!has_geometry)
      findings_.add("geometry_missing", place,
                    "<" + std::string(tag.Name()) + "> has no geometry and is left out");
  }

  bool read_geometry(const XMLElement& tag, const Place& place, ShapeTag& shape) {
    const XMLElement* const form = tag.FirstChildElement();
    if (form == nullptr) return false;
    if (const XMLElement* const other = form->NextSiblingElement())
      findings_.add("tag_repeated", {place.name, line_of(*other)},
                    "its <geometry> has more than one shape; the first one counts");
    const std::string_view name = form->Name();
    if (name == "mesh") {
      MeshTag& mesh = shape.mesh.emplace();
      mesh.filename = attribute_of(*form, "filename");
      numbers(*form, "scale", place, mesh.scale);
    } else if (name == "box") {
      required(*form, "size", place, shape.box.emplace().size);
    } else if (name == "cylinder") {
      CylinderTag& cylinder = shape.cylinder.emplace();
      required(*form, "radius", place, {&cylinder.radius, 1});
      required(*form, "length", place, {&cylinder.length, 1});
    } else if (name == "sphere") {
      required(*form, "radius", place, {&shape.sphere.emplace().radius, 1});
    } else {
      findings_.add("geometry_unknown", {place.name, line_of(*form)},
                    "geometry <" + std::string(name.substr(0, 40)) +
                        "> is none of mesh, box, cylinder and sphere, and is left out");
      return false;
    }
    return true;
  }

  OriginTag read_origin(const XMLElement& tag, const Place& place) {
    OriginTag origin;
    numbers(tag, "xyz", place, origin.xyz);
    numbers(tag, "rpy", place, origin.rpy);
    if (tag.Attribute("quat_xyzw") != nullptr)
      findings_.add("quaternion_ignored", {place.name, line_of(tag)},
                    std::string("quat_xyzw is not read; the rotation is ") +
                        (tag.Attribute("rpy") != nullptr ? "that of rpy" : "none"));
    return origin;
  }

  MaterialTag read_material(const XMLElement& tag, const Place& place) {
    MaterialTag material;
    material.name = attribute_of(tag, "name");
    material.line = line_of(tag);
    const Place own = place.name.empty() ? place_of("material", material.name, 0) : place;
    for (const XMLElement* child = tag.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      const std::string_view name = child->Name();
      if (name == "color") {
        std::array<double, 4> rgba = {0, 0, 0, 1};
        if (numbers(*child, "rgba", own, rgba)) material.rgba = rgba;
      } else {
        ignored_.add("material", *child);
      }
    }
    return material;
  }

  // ---- Joints

  JointTag read_joint(const XMLElement& tag) {
    JointTag joint;
    joint.name = attribute_of(tag, "name");
    joint.type = attribute_of(tag, "type");
    joint.line = line_of(tag);
    const Place place = place_of(joint);
    for (const XMLElement* child = tag.FirstChildElement(); child;
         child = child->NextSiblingElement())
      read_part(*child, place, joint);
    return joint;
  }

  void read_part(const XMLElement& tag, const Place& place, JointTag& joint) {
    const std::string_view name = tag.Name();
    if (is_single_part(name) && is_repeated(tag, place)) return;
    if (name == "origin") {
      joint.origin = read_origin(tag, place);
    } else if (name == "parent") {
      joint.parent = attribute_of(tag, "link");
    } else if (name == "child") {
      joint.child = attribute_of(tag, "link");
    } else if (name == "axis") {
      Numbers3 axis = {1, 0, 0};
      if (numbers(tag, "xyz", place, axis)) joint.axis = axis;
    } else if (name == "limit") {
      joint.limit = read_limit(tag, place);
    } else if (name == "mimic") {
      MimicTag& mimic = joint.mimic.emplace();
      mimic.joint = attribute_of(tag, "joint");
      numbers(tag, "multiplier", place, {&mimic.multiplier, 1});
      numbers(tag, "offset", place, {&mimic.offset, 1});
    } else if (name != "dynamics" && name != "calibration" && name != "safety_controller") {
      ignored_.add("joint", tag);
    }
  }

  LimitTag read_limit(const XMLElement& tag, const Place& place) {
    LimitTag limit;
    double bound = 0;
    if (numbers(tag, "lower", place, {&bound, 1})) limit.lower = bound;
    if (numbers(tag, "upper", place, {&bound, 1})) limit.upper = bound;
    numbers(tag, "effort", place, {&limit.effort, 1});
    numbers(tag, "velocity", place, {&limit.velocity, 1});
    return limit;
  }

  // ---- Macros

  /// Macros that were not expanded, in tags or attributes, anywhere.
  void find_xacro(const XMLElement& root) {
    std::uint32_t count = 0, first_line = 0;
    std::string first;
    const auto found = [&](const XMLElement& tag, const std::string& text) {
      if (count++ > 0) return;
      first_line = line_of(tag);
      first = text.substr(0, 60);
    };
    std::vector<const XMLElement*> open = {&root};
    while (!open.empty()) {
      const XMLElement* const tag = open.back();
      open.pop_back();
      if (std::string_view(tag->Name()).starts_with("xacro:"))
        found(*tag, "<" + std::string(tag->Name()) + ">");
      for (const auto* attribute = tag->FirstAttribute(); attribute;
           attribute = attribute->Next()) {
        const std::string_view value = attribute->Value();
        if (value.find("${") != std::string_view::npos ||
            value.find("$(") != std::string_view::npos)
          found(*tag, std::string(attribute->Name()) + "=\"" + std::string(value) + "\"");
      }
      for (const XMLElement* child = tag->LastChildElement(); child;
           child = child->PreviousSiblingElement())
        open.push_back(child);
    }
    if (count > 0)
      findings_.add("xacro_not_expanded", {"", first_line},
                    first +
                        (count > 1 ? " and " + std::to_string(count - 1) + " more are" : " is") +
                        " for xacro, which has to expand the file first: xacro FILE > robot.urdf");
  }

  Findings& findings_;
  IgnoredTags ignored_;
};

}  // namespace

RobotTags read_tags(const std::string& text, Findings& findings) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    const bool is_deep = document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED;
    findings.add(is_deep ? "xml_too_deep" : "xml_malformed",
                 {"", static_cast<std::uint32_t>(std::max(document.ErrorLineNum(), 0))},
                 "not well-formed XML: " + words_of(document));
    return {};
  }
  const XMLElement* const root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "robot") {
    const std::string name = root == nullptr ? "nothing" : "<" + std::string(root->Name()) + ">";
    findings.add("not_urdf", {"", root == nullptr ? 0 : line_of(*root)},
                 "the file begins with " + name.substr(0, 60) + "; URDF begins with <robot>");
    return {};
  }
  if (const XMLElement* const other = root->NextSiblingElement())
    findings.add("tag_repeated", {"", line_of(*other)},
                 "<" + std::string(other->Name()).substr(0, 60) +
                     "> begins after the end of the robot; it and what follows are ignored");
  return TagReader(findings).read(*root);
}

}  // namespace sunder::urdf
