#include "io/gltf/node_tree.h"

#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

constexpr std::uint32_t kMaximumDepth = 1024;

/// Depth of every node; refuses cycles. A node that no root reaches is on a cycle or below one.
void check_depths(const NodeTree& tree) {
  const auto count = static_cast<std::uint32_t>(tree.parent.size());
  std::vector<std::uint32_t> depth(count, kNone), open;
  for (std::uint32_t node = 0; node < count; ++node)
    if (tree.parent[node] == kNone) {
      depth[node] = 1;
      open.push_back(node);
    }
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    if (depth[node] > kMaximumDepth)
      refuse(StatusCode::limit_exceeded, node, "/nodes/%u: nested deeper than %u levels", node,
             kMaximumDepth);
    for (const std::uint32_t child : tree.children[node]) {
      depth[child] = depth[node] + 1;
      open.push_back(child);
    }
  }
  for (std::uint32_t node = 0; node < count; ++node) {
    if (depth[node] != kNone) continue;
    // After `count` steps towards the root the node is on the cycle.
    std::uint32_t on_cycle = node;
    for (std::uint32_t step = 0; step < count; ++step) on_cycle = tree.parent[on_cycle];
    refuse(StatusCode::not_a_tree, on_cycle,
           "/nodes/%u/children: node %u is its own ancestor through its parent %u",
           tree.parent[on_cycle], on_cycle, tree.parent[on_cycle]);
  }
}

}  // namespace

NodeTree read_node_tree(const Json& document) {
  const std::size_t count = count_of(document, "nodes");
  if (count >= kNone)
    refuse(StatusCode::limit_exceeded, kNone, "/nodes: %zu nodes; at most 4294967294 are supported",
           count);
  NodeTree tree;
  tree.parent.assign(count, kNone);
  tree.children.resize(count);
  for (std::uint32_t node = 0; node < count; ++node) {
    const auto children = entry(document, "nodes", node).find("children");
    if (!children) continue;
    for (std::size_t i = 0; i < children->size(); ++i) {
      const std::uint32_t child = children->element(i).to_index(count, "node");
      if (tree.parent[child] != kNone)
        refuse(StatusCode::not_a_tree, child,
               "/nodes/%u/children/%zu: node %u is already a child of node %u", node, i, child,
               tree.parent[child]);
      tree.parent[child] = node;
      tree.children[node].push_back(child);
    }
  }
  check_depths(tree);
  return tree;
}

}  // namespace sunder::gltf
