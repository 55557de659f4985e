#pragma once

#include <sunder/robot/robot.h>

#include <vector>

#include "io/urdf/link_tree.h"
#include "io/urdf/mimic_chains.h"
#include "io/urdf/parse_by_urdfdom.h"
#include "io/urdf/tags.h"

namespace sunder::urdf {

/// Puts the parts of a robot together.
[[nodiscard]] Robot make_robot(const RobotTags& tags, const ParsedRobot& parsed,
                               const LinkTree& tree, const std::vector<MimicChain>& chains);

}  // namespace sunder::urdf
