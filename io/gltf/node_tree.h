#pragma once

#include <sunder/core/math.h>

#include <vector>

#include "io/gltf/cursor.h"

namespace sunder::gltf {

/// The nodes' hierarchy, checked to be a forest of bounded depth.
struct NodeTree {
  std::vector<std::uint32_t> parent;  ///< One a node; kNone at roots.
  std::vector<std::vector<std::uint32_t>> children;

  [[nodiscard]] std::uint32_t root_of(std::uint32_t node) const {
    while (parent[node] != kNone) node = parent[node];
    return node;
  }
};

/// @throws Refusal  not_a_tree, with both nodes named, where a node has two parents or is its own
/// ancestor; limit_exceeded below level
///         1024.
[[nodiscard]] NodeTree read_node_tree(const Json& document);

}  // namespace sunder::gltf
