#pragma once

#include <cstdint>
#include <vector>

#include "io/urdf/findings.h"
#include "io/urdf/tags.h"

namespace sunder::urdf {

/// How a joint follows others. Indices are those of RobotTags::joints.
struct MimicChain {
  std::uint32_t mimicked = kNone;     ///< The next joint of the chain; kNone: it follows none.
  std::uint32_t driving = kNone;      ///< The last one; kNone: it follows none, or a fixed joint.
  bool stands_still = false;          ///< It follows a fixed joint, so it stands at `offset`.
  double multiplier = 1, offset = 0;  ///< Position = multiplier * driving position + offset.
};

/// Follows the chains of mimic joints to their ends, one entry per joint. A joint whose chain is
/// broken, or runs in a circle, moves on its own; that is a finding. O(joints log joints).
[[nodiscard]] std::vector<MimicChain> resolve_mimics(const RobotTags& tags, Findings& findings);

}  // namespace sunder::urdf
