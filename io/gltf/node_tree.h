#pragma once

#include <sunder/core/math.h>

#include <vector>

#include "io/gltf/cursor.h"

namespace sunder::gltf {

/// The hierarchy of nodes, checked to be a forest of limited depth.
struct NodeTree {
  std::vector<std::uint32_t> parent;  ///< One per node; kNone for roots.
  std::vector<std::vector<std::uint32_t>> children;

  [[nodiscard]] std::uint32_t root_of(std::uint32_t node) const {
    while (parent[node] != kNone) node = parent[node];
    return node;
  }
};

///
/// @throws Refusal  not_a_tree, with both nodes in the text, if a node has two parents or is its
///         own ancestor; limit_exceeded below level 1024.
[[nodiscard]] NodeTree read_node_tree(const Json& document);

}  // namespace sunder::gltf
