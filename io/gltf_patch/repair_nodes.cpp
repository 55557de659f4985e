#include "io/gltf_patch/repair_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/gltf/decompose.h"
#include "io/gltf/glb.h"
#include "io/gltf/node_tree.h"

namespace sunder::gltf {
namespace {

// A little less than the reader's, so that the written file needs no repair; the Khronos validator
// allows more.
constexpr double kRotationTolerance = 0.00009;
// The tolerance of the Khronos validator.
constexpr double kMatrixTolerance = 0.00005;

Json numbers(const float* values, std::size_t count) {
  Json list = Json::array();
  for (std::size_t i = 0; i < count; ++i) list.push_back(static_cast<double>(values[i]));
  return list;
}

void write_transform(const BoneTransform& transform, Json& node) {
  for (const char* const key : {"matrix", "translation", "rotation", "scale"}) node.erase(key);
  node["translation"] = numbers(transform.translation.data(), 3);
  node["rotation"] = numbers(transform.rotation.coeffs().data(), 4);
  node["scale"] = numbers(transform.scale.data(), 3);
}

void make_rotation_unit(Json& node) {
  const auto found = node.find("rotation");
  if (found == node.end()) return;
  double squared = 0;
  for (const Json& one : *found) squared += one.get<double>() * one.get<double>();
  const double length = std::sqrt(squared);
  const bool is_inside = std::all_of(found->begin(), found->end(), [](const Json& one) {
    return std::abs(one.get<double>()) <= 1.0;
  });
  if (std::abs(length - 1.0) <= kRotationTolerance && is_inside) return;
  if (length < 1e-6) {
    node.erase("rotation");
    return;
  }
  for (Json& one : *found) one = std::clamp(one.get<double>() / length, -1.0, 1.0);
}

/// As the validator decides it: the last row is exact, the matrix is invertible, and its
/// decomposition reproduces it.
bool is_product(const Eigen::Matrix4d& matrix, const Decomposition& parts) {
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1) || parts.second) return false;
  const Mat3d linear = matrix.topLeftCorner<3, 3>();
  if (linear.determinant() == 0.0) return false;
  const Mat3d again = parts.first.rotation.cast<double>().toRotationMatrix() *
                      parts.first.scale.cast<double>().asDiagonal();
  return (again - linear).cwiseAbs().maxCoeff() < kMatrixTolerance;
}

class NodeRepair {
 public:
  explicit NodeRepair(Json& document) : document_(document) {}

  void run() {
    if (!document_.contains("nodes")) {
      document_.erase("skins");
      if (document_.contains("scenes"))
        for (Json& scene : document_["scenes"]) scene.erase("nodes");
      return;
    }
    tree_ = read_node_tree(document_);
    const std::size_t count = document_["nodes"].size();
    for (std::uint32_t node = 0; node < count; ++node) repair_transform(node);
    for (std::uint32_t node = 0; node < count; ++node) repair_mesh(node);
    repair_scenes();
    if (!document_.contains("skins")) return;
    for (Json& skin : document_["skins"]) repair_joints(skin);
    gather_roots();
    for (Json& skin : document_["skins"]) repair_skeleton(skin);
    if (document_.contains("scenes"))
      for (Json& scene : document_["scenes"]) add_joints_to_scene(scene);
  }

 private:
  Json& node_at(std::uint32_t node) { return document_["nodes"][node]; }

  std::uint32_t append(Json node, std::uint32_t parent) {
    Json& nodes = document_["nodes"];
    nodes.push_back(std::move(node));
    tree_.parent.push_back(parent);
    tree_.children.emplace_back();
    return static_cast<std::uint32_t>(nodes.size() - 1);
  }

  void repair_transform(std::uint32_t index) {
    Json& node = node_at(index);
    make_rotation_unit(node);
    const auto found = node.find("matrix");
    if (found == node.end()) return;
    for (const char* const key : {"translation", "rotation", "scale"}) node.erase(key);
    const Json entries = *node.find("matrix");
    Eigen::Matrix4d matrix;
    for (int i = 0; i < 16; ++i)
      matrix.data()[i] = static_cast<double>(entries[static_cast<std::size_t>(i)].get<float>());
    if (!matrix.allFinite()) {
      node.erase("matrix");
      return;
    }
    Affine3d affine;
    affine.matrix() = matrix.topRows<3>();
    const Decomposition parts = decompose(affine);
    if (is_product(matrix, parts)) return;
    if (parts.second) {
      insert_above(index, parts.first);
      write_transform(*parts.second, node_at(index));
    } else {
      write_transform(parts.first, node_at(index));
    }
  }

  /// The reader makes two bones of such a matrix in the same way.
  void insert_above(std::uint32_t index, const BoneTransform& transform) {
    Json above = Json::object();
    const std::string name = Cursor(node_at(index), "").name();
    above["name"] = (name.empty() ? "node " + std::to_string(index) : name) + "#shear";
    write_transform(transform, above);
    above["children"] = Json::array({index});
    const std::uint32_t parent = tree_.parent[index];
    const std::uint32_t inserted = append(std::move(above), parent);
    tree_.parent[index] = inserted;
    const auto replace = [&](Json& list) {
      for (Json& one : list)
        if (one == index) one = inserted;
    };
    if (parent != kNone) replace(node_at(parent)["children"]);
    if (document_.contains("scenes"))
      for (Json& scene : document_["scenes"])
        if (scene.contains("nodes")) replace(scene["nodes"]);
  }

  static bool is_skinned(const Json& primitive) {
    return primitive["attributes"].contains("JOINTS_0");
  }

  void repair_mesh(std::uint32_t index) {
    Json& node = node_at(index);
    if (!node.contains("mesh")) {
      for (const char* const key : {"skin", "weights"}) node.erase(key);
      return;
    }
    const auto mesh_index = node["mesh"].get<std::size_t>();
    const Json& primitives = document_["meshes"][mesh_index]["primitives"];
    const auto targets = primitives[0].find("targets");
    const std::size_t count = targets == primitives[0].end() ? 0 : targets->size();
    if (node.contains("weights") && node["weights"].size() != count) fit_weights(node, count);
    if (!node.contains("skin")) return;
    const auto skinned =
        static_cast<std::size_t>(std::count_if(primitives.begin(), primitives.end(), is_skinned));
    if (skinned == 0) node.erase("skin");
    if (skinned > 0 && skinned < primitives.size()) split_mesh(index, mesh_index);
  }

  static void fit_weights(Json& object, std::size_t count) {
    Json weights = object["weights"];
    Json fitting = Json::array();
    for (std::size_t i = 0; i < count; ++i)
      fitting.push_back(i < weights.size() ? weights[i] : Json(0.0));
    if (fitting.empty())
      object.erase("weights");
    else
      object["weights"] = std::move(fitting);
  }

  /// Primitives without joints follow the node, so they go to a child of it.
  void split_mesh(std::uint32_t index, std::size_t mesh_index) {
    Json skinned = document_["meshes"][mesh_index], rigid = skinned;
    const auto keep = [](Json& mesh, bool wanted) {
      Json kept = Json::array();
      for (Json& primitive : mesh["primitives"])
        if (is_skinned(primitive) == wanted) kept.push_back(std::move(primitive));
      mesh["primitives"] = std::move(kept);
    };
    keep(skinned, true);
    keep(rigid, false);
    Json& meshes = document_["meshes"];
    meshes.push_back(std::move(skinned));
    meshes.push_back(std::move(rigid));
    Json child = {{"mesh", meshes.size() - 1}};
    if (node_at(index).contains("weights")) child["weights"] = node_at(index)["weights"];
    const std::uint32_t below = append(std::move(child), index);
    Json& node = node_at(index);
    node["mesh"] = meshes.size() - 2;
    Json& children = list_of(node, "children");
    children.insert(children.begin(), below);
  }

  void repair_scenes() {
    if (!document_.contains("scenes")) return;
    for (Json& scene : document_["scenes"]) {
      if (!scene.contains("nodes")) continue;
      Json roots = Json::array();
      std::set<std::uint32_t> seen;
      for (const Json& node : scene["nodes"]) {
        const std::uint32_t root = tree_.root_of(node.get<std::uint32_t>());
        if (seen.insert(root).second) roots.push_back(root);
      }
      if (roots != scene["nodes"]) scene["nodes"] = std::move(roots);
    }
  }

  /// Joints must be different nodes; a repeated one gets a child that is always at the same place.
  void repair_joints(Json& skin) {
    std::set<std::uint64_t> seen;
    const std::size_t count = document_["nodes"].size();
    for (Json& joint : skin["joints"]) {
      const double number = joint.get<double>();
      const bool is_node = number < static_cast<double>(count) && number == std::floor(number);
      if (!is_node || !joint.is_number_integer())
        joint = is_node ? static_cast<std::uint64_t>(number) : 0u;
      if (seen.insert(joint.get<std::uint64_t>()).second) continue;
      const auto parent = joint.get<std::uint32_t>();
      const std::uint32_t child = append(Json::object(), parent);
      list_of(node_at(parent), "children").push_back(child);
      joint = child;
      seen.insert(child);
    }
  }

  std::set<std::uint32_t> roots_of(const Json& skin) const {
    std::set<std::uint32_t> roots;
    for (const Json& joint : skin["joints"])
      roots.insert(tree_.root_of(joint.get<std::uint32_t>()));
    return roots;
  }

  /// Trees in which one skin has joints become one tree. It stays flat however many skins join
  /// trees, because readers limit the depth.
  void gather_roots() {
    std::set<std::uint32_t> added;
    const std::size_t skin_count = document_["skins"].size();
    for (std::size_t i = 0; i < skin_count; ++i) {
      const std::set<std::uint32_t> roots = roots_of(document_["skins"][i]);
      if (roots.size() < 2) continue;
      const auto known = std::find_if(roots.begin(), roots.end(),
                                      [&](std::uint32_t root) { return added.contains(root); });
      const std::uint32_t above =
          known != roots.end() ? *known : append({{"name", "Skeleton"}, {"children", {}}}, kNone);
      added.insert(above);
      for (const std::uint32_t root : roots) {
        if (root == above) continue;
        if (added.contains(root)) take_children(root, above);
        take(root, above);
      }
    }
    repair_scenes();
  }

  void take(std::uint32_t child, std::uint32_t above) {
    list_of(node_at(above), "children").push_back(child);
    tree_.parent[child] = above;
  }

  void take_children(std::uint32_t from, std::uint32_t to) {
    const Json children = node_at(from)["children"];
    node_at(from).erase("children");
    for (const Json& child : children) take(child.get<std::uint32_t>(), to);
  }

  [[nodiscard]] bool is_above(std::uint32_t ancestor, std::uint32_t node) const {
    while (node != kNone && node != ancestor) node = tree_.parent[node];
    return node == ancestor;
  }

  void repair_skeleton(Json& skin) const {
    const auto found = skin.find("skeleton");
    if (found == skin.end()) return;
    const auto root = found->get<std::uint32_t>();
    for (const Json& joint : skin["joints"])
      if (!is_above(root, joint.get<std::uint32_t>())) {
        skin.erase("skeleton");
        return;
      }
  }

  void add_joints_to_scene(Json& scene) {
    if (!scene.contains("nodes")) return;
    std::vector<std::uint32_t> open;
    std::set<std::uint32_t> roots;
    for (const Json& node : scene["nodes"]) {
      open.push_back(node.get<std::uint32_t>());
      roots.insert(open.back());
    }
    while (!open.empty()) {
      const Json& node = node_at(open.back());
      open.pop_back();
      if (node.contains("children"))
        for (const Json& child : node["children"]) open.push_back(child.get<std::uint32_t>());
      if (!node.contains("skin")) continue;
      for (const std::uint32_t root : roots_of(document_["skins"][node["skin"].get<std::size_t>()]))
        if (roots.insert(root).second) {
          scene["nodes"].push_back(root);
          open.push_back(root);
        }
    }
  }

  Json& document_;
  NodeTree tree_;
};

}  // namespace

void repair_nodes(Json& document) { NodeRepair(document).run(); }

}  // namespace sunder::gltf
