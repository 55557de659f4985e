#include "io/gltf_read/skeleton.h"

#include <array>
#include <cmath>

#include "io/gltf/decompose.h"
#include "io/gltf/names.h"
#include "io/gltf/node_tree.h"
#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

// The tolerance for the last row of a matrix, as in skins.cpp.
constexpr float kRounding = 1e-6f, kLargestRounding = 1e-3f;

template <std::size_t N>
bool read_numbers(const Cursor& node, const char* key, std::array<float, N>& out) {
  const auto at = node.find(key);
  if (!at) return false;
  if (at->size() != N)
    refuse(StatusCode::malformed_file, kNone, "%s: found %zu numbers, expected %zu",
           at->pointer().c_str(), at->size(), N);
  for (std::size_t i = 0; i < N; ++i) out[i] = at->element(i).to_float();
  return true;
}

Quatf read_rotation(Reading& reading, const Cursor& node, const std::array<float, 4>& xyzw) {
  const Quatd rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  const double norm = rotation.norm();
  if (norm < 1e-6) {
    reading.notes.repaired(StatusCode::malformed_file, kNone, node.pointer(),
                           "a rotation of length zero became the identity");
    return Quatf::Identity();
  }
  const double deviation = std::abs(norm - 1.0);
  if (deviation > 1e-4)
    reading.notes.repaired(StatusCode::malformed_file, kNone, node.pointer(),
                           "a rotation that was not of unit length was normalised");
  // A quaternion that has unit length in float precision keeps its bits.
  if (deviation <= 1e-6) return Quatf(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  return rotation.normalized().cast<float>();
}

Decomposition read_transform(Reading& reading, const Cursor& node) {
  std::array<float, 16> matrix{};
  if (read_numbers(node, "matrix", matrix)) {
    Eigen::Matrix4f columns = Eigen::Map<const Eigen::Matrix4f>(matrix.data());
    const float error = (columns.row(3) - Eigen::RowVector4f(0, 0, 0, 1)).cwiseAbs().maxCoeff();
    if (error > kLargestRounding)
      refuse(StatusCode::malformed_file, kNone, "%s/matrix: its last row is not 0 0 0 1",
             node.pointer().c_str());
    if (error > kRounding)
      reading.notes.repaired(StatusCode::malformed_file, kNone, node.pointer(),
                             "a matrix whose last row was not 0 0 0 1 was corrected");
    Affine3d affine;
    affine.matrix() = columns.topRows<3>().cast<double>();
    return decompose(affine);
  }
  std::array<float, 3> translation{0, 0, 0}, scale{1, 1, 1};
  std::array<float, 4> rotation{0, 0, 0, 1};
  read_numbers(node, "translation", translation);
  read_numbers(node, "scale", scale);
  BoneTransform transform;
  if (read_numbers(node, "rotation", rotation))
    transform.rotation = read_rotation(reading, node, rotation);
  transform.translation = {translation[0], translation[1], translation[2]};
  transform.scale = {scale[0], scale[1], scale[2]};
  return {transform, std::nullopt};
}

/// Appends the tree below `root` to `order`, parents first.
void append_tree(const NodeTree& tree, std::uint32_t root, std::vector<bool>& visited,
                 std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> open = {root};
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    if (visited[node]) continue;
    visited[node] = true;
    order.push_back(node);
    open.insert(open.end(), tree.children[node].rbegin(), tree.children[node].rend());
  }
}

std::vector<std::uint32_t> scene_roots(Reading& reading, const NodeTree& tree) {
  const Json& json = reading.json();
  std::vector<std::uint32_t> roots;
  const std::size_t scene_count = count_of(json, "scenes");
  if (scene_count == 0) {
    for (std::uint32_t node = 0; node < tree.parent.size(); ++node)
      if (tree.parent[node] == kNone) roots.push_back(node);
    return roots;
  }
  const auto chosen = Cursor(json, "").find("scene");
  const Cursor scene = entry(json, "scenes", chosen ? chosen->to_index(scene_count, "scene") : 0);
  const auto nodes = scene.find("nodes");
  std::uint32_t with_parent = 0;
  for (std::size_t i = 0; nodes && i < nodes->size(); ++i) {
    const std::uint32_t node = nodes->element(i).to_index(tree.parent.size(), "node");
    if (tree.parent[node] != kNone) ++with_parent;
    roots.push_back(tree.root_of(node));
  }
  if (with_parent > 0)
    reading.notes.repaired(StatusCode::malformed_file, kNone, nodes->pointer(),
                           "the scene lists nodes that have a parent; the whole trees are used",
                           with_parent);
  return roots;
}

/// Joints of the scene's skins that are in no tree of the scene.
std::vector<std::uint32_t> outside_joints(Reading& reading,
                                          const std::vector<std::uint32_t>& scene_nodes,
                                          const std::vector<bool>& visited) {
  const Json& json = reading.json();
  std::vector<std::uint32_t> joints;
  std::vector<bool> seen(count_of(json, "skins"));
  for (const std::uint32_t node : scene_nodes) {
    const Cursor at = entry(json, "nodes", node);
    const auto skin_at = at.find("skin");
    if (!skin_at || !at.find("mesh")) continue;
    const std::uint32_t skin = skin_at->to_index(seen.size(), "skin");
    if (seen[skin]) continue;
    seen[skin] = true;
    const Cursor list = entry(json, "skins", skin).member("joints");
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::uint32_t joint = list.element(i).to_index(visited.size(), "node");
      if (!visited[joint]) joints.push_back(joint);
    }
  }
  return joints;
}

}  // namespace

NodeSkeleton read_skeleton(Reading& reading) {
  // A node as JSON takes at least three bytes, as a bone with its name and place some hundreds.
  constexpr std::uint64_t kNodeMemory = 400;
  reading.accessors.charge(count_of(reading.json(), "nodes") * kNodeMemory, "/nodes");
  const NodeTree tree = read_node_tree(reading.json());
  NodeSkeleton result;
  std::vector<bool> visited(tree.parent.size());
  for (const std::uint32_t root : scene_roots(reading, tree))
    append_tree(tree, root, visited, result.scene_nodes);
  std::vector<std::uint32_t> order = result.scene_nodes;
  const auto outside = outside_joints(reading, result.scene_nodes, visited);
  for (const std::uint32_t joint : outside) append_tree(tree, tree.root_of(joint), visited, order);
  if (!outside.empty())
    reading.notes.inform("skeleton", "joints outside the scene were added, with their whole trees",
                         static_cast<std::uint32_t>(outside.size()));

  result.bone_from_node.assign(tree.parent.size(), kNone);
  std::vector<std::string> names;
  std::uint32_t sheared = 0;
  for (const std::uint32_t node : order) {
    const Cursor at = entry(reading.json(), "nodes", node);
    const Decomposition transform = read_transform(reading, at);
    std::uint32_t parent =
        tree.parent[node] == kNone ? kNone : result.bone_from_node[tree.parent[node]];
    auto& bones = result.skeleton.bones;
    if (transform.second) {
      ++sheared;
      const std::string name = at.name();
      names.push_back((name.empty() ? "node " + std::to_string(node) : name) + "#shear");
      bones.push_back({{}, parent, transform.first});
      parent = static_cast<std::uint32_t>(bones.size() - 1);
    }
    result.bone_from_node[node] = static_cast<std::uint32_t>(bones.size());
    names.push_back(at.name());
    bones.push_back({{}, parent, transform.second.value_or(transform.first)});
  }
  if (sheared > 0)
    reading.notes.inform(
        "skeleton", "matrices with shear were split into two bones, the second named '…#shear'",
        sheared);
  if (const std::size_t renamed = make_unique(names, "bone"); renamed > 0)
    reading.notes.inform("skeleton", "nodes without a unique name were renamed",
                         static_cast<std::uint32_t>(renamed));
  for (std::size_t i = 0; i < names.size(); ++i)
    result.skeleton.bones[i].name = std::move(names[i]);
  return result;
}

}  // namespace sunder::gltf
