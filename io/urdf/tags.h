#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/urdf/findings.h"

namespace sunder::urdf {

using Numbers3 = std::array<double, 3>;

struct OriginTag {
  Numbers3 xyz = {0, 0, 0}, rpy = {0, 0, 0};  ///< Metres; radians, about fixed axes.
};

struct MeshTag {
  std::string filename;
  Numbers3 scale = {1, 1, 1};
};

struct BoxTag {
  Numbers3 size = {0, 0, 0};
};

struct CylinderTag {
  double radius = 0, length = 0;
};

struct SphereTag {
  double radius = 0;
};

struct MaterialTag {
  std::string name;
  std::uint32_t line = 0;
  std::optional<std::array<double, 4>> rgba;
};

/// A `<visual>` or `<collision>` with a geometry that is understood: exactly one is there.
struct ShapeTag {
  std::uint32_t line = 0;
  OriginTag origin;
  std::optional<MeshTag> mesh;
  std::optional<BoxTag> box;
  std::optional<CylinderTag> cylinder;
  std::optional<SphereTag> sphere;
  std::optional<MaterialTag> material;
};

struct LinkTag {
  std::string name;
  std::uint32_t line = 0;
  std::vector<ShapeTag> visuals, collisions;
};

struct LimitTag {
  std::optional<double> lower, upper;
  double effort = 0, velocity = 0;
};

struct MimicTag {
  std::string joint;
  double multiplier = 1, offset = 0;
};

struct JointTag {
  std::string name, type, parent, child;
  std::uint32_t line = 0;
  OriginTag origin;
  std::optional<Numbers3> axis;
  std::optional<LimitTag> limit;
  std::optional<MimicTag> mimic;
};

/// The parts of a URDF file that say how the robot looks and moves, in the order of the file.
struct RobotTags {
  std::string name;
  std::vector<LinkTag> links;
  std::vector<JointTag> joints;
  std::vector<MaterialTag> materials;
};

[[nodiscard]] inline Place place_of(const LinkTag& link) {
  return place_of("link", link.name, link.line);
}
[[nodiscard]] inline Place place_of(const JointTag& joint) {
  return place_of("joint", joint.name, joint.line);
}

}  // namespace sunder::urdf
