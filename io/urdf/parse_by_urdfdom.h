#pragma once

#include <sunder/core/math.h>

#include <optional>
#include <vector>

#include "io/urdf/findings.h"
#include "io/urdf/tags.h"

namespace sunder::urdf {

/// The numbers that urdfdom reads from joints and shapes, in the order of RobotTags.
struct ParsedRobot {
  struct Joint {
    Affine3d parent_from_joint = Affine3d::Identity();
    Vec3d axis = Vec3d::UnitX();  ///< Unit length.
    double lower = 0, upper = 0, effort = 0, velocity = 0;
  };
  struct Link {
    std::vector<Affine3d> link_from_visual, link_from_collision;
  };
  std::vector<Joint> joints;
  std::vector<Link> links;
};

/// Parses checked and repaired tags by urdfdom, which sees a text that is written from them: names
/// are replaced by numbers, and what Sunder does not use is left out. If urdfdom refuses it, that
/// is a finding, with what urdfdom says. Thread-safe: calls take turns.
[[nodiscard]] std::optional<ParsedRobot> parse_by_urdfdom(const RobotTags& tags,
                                                          Findings& findings);

}  // namespace sunder::urdf
