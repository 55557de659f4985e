#pragma once

#include <cstdint>
#include <vector>

#include "io/urdf/findings.h"
#include "io/urdf/tags.h"

namespace sunder::urdf {

/// The links of a file in the order of Robot::links. Indices are those of RobotTags.
struct LinkTree {
  std::vector<std::uint32_t> links;    ///< Parents first, depth first, children in file order.
  std::vector<std::uint32_t> joints;   ///< joints[i] moves links[i + 1].
  std::vector<std::uint32_t> parents;  ///< In `links`; parents[0] is kNone.
};

/// Orders the links, after checking that all names exist once and that joints connect all links to
/// one tree. What is wrong becomes a finding; the tree is used only if none of them is an error.
/// Iterative, O(links log links).
[[nodiscard]] LinkTree make_link_tree(const RobotTags& tags, Findings& findings);

}  // namespace sunder::urdf
