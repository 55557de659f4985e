#include "io/assimp/scene_tree.h"

#include <utility>

#include "io/assimp/failure.h"

namespace sunder::assimp_import {
namespace {

constexpr std::uint32_t kMaximumDepth = 1024;
/// Largest relative deviation from right angles that counts as rounding. Ignoring it moves no
/// vertex by more than this fraction of its distance. Text formats round to four or five digits, so
/// where shear is removed anyway, this much is not noted.
constexpr double kShear = 1e-5;
constexpr double kNotedShear = 1e-4;

template <class Vector>
Json float_array(const Vector& values) {
  Json array = Json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i)
    array.push_back(static_cast<double>(static_cast<float>(values[i])));
  return array;
}

void write_transform(const Trs& trs, Json& node) {
  if (trs.translation != Vec3d::Zero()) node["translation"] = float_array(trs.translation);
  if (trs.rotation.coeffs() != Quatd::Identity().coeffs())
    node["rotation"] = float_array(trs.rotation.coeffs());
  if (trs.scale != Vec3d::Ones()) node["scale"] = float_array(trs.scale);
}

}  // namespace

std::string to_string(const aiString& text) {
  return {text.data, std::min<std::size_t>(text.length, sizeof text.data)};
}

SceneTree::SceneTree(const aiScene& scene, const ModelSpace& space, JointNodes joints, Notes& notes)
    : joints_(std::move(joints)) {
  for (unsigned i = 0; i < scene.mNumAnimations; ++i)
    for (unsigned k = 0; k < scene.mAnimations[i]->mNumChannels; ++k)
      animated_.insert(to_string(scene.mAnimations[i]->mChannels[k]->mNodeName));

  std::uint32_t top = kNone;
  if (!space.is_identity) {
    SceneNode root;
    root.name = unique_name("model_from_file");
    root.parent_from_node = space.model_from_scene;
    top = push(std::move(root));
  }

  struct Pending {
    const aiNode* node;
    std::uint32_t parent, depth;
  };
  std::vector<Pending> pending = {{scene.mRootNode, top, 1}};
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    if (next.depth >= kMaximumDepth)
      throw ImportFailure{Status::failure(StatusCode::limit_exceeded, kNone,
                                          "nodes are nested deeper than %u", kMaximumDepth)};
    const std::uint32_t index = add_node(*next.node, next.parent, notes);
    for (unsigned i = next.node->mNumChildren; i-- > 0;)
      if (next.node->mChildren[i] != nullptr)
        pending.push_back({next.node->mChildren[i], index, next.depth + 1});
  }
}

std::uint32_t SceneTree::add_node(const aiNode& source, std::uint32_t parent, Notes& notes) {
  const std::string source_name = to_string(source.mName);
  SceneNode node;
  const std::string readable = valid_utf8(source_name);
  if (readable != source_name)
    notes.repaired(StatusCode::malformed_file, "names", "not UTF-8; bad bytes replaced");
  node.name = unique_name(readable);
  if (node.name != readable) {
    node.json["extras"]["source_name"] = readable;
    notes.inform("node '" + readable + "'",
                 "several nodes have this name; a number was appended to the later ones");
  }
  node.source = &source;
  const std::string place = "node '" + node.name + "'";

  Mat4d matrix = to_eigen(source.mTransformation);
  if (!matrix.allFinite()) {
    notes.repaired(StatusCode::non_finite_value, place,
                   "transform is not finite, replaced by identity");
    matrix.setIdentity();
  }
  node.parent_from_node = decompose(matrix);
  const double shear = linear_difference(matrix, matrix_of(node.parent_from_node));
  if (shear > kShear) {
    if (animated_.contains(source_name)) {
      if (shear > kNotedShear)
        notes.repaired(StatusCode::unsupported_feature, place,
                       "shear removed from an animated node");
    } else {
      // A glTF node cannot have shear, but the product of two nodes can.
      const ShearParts parts = split_shear(matrix);
      SceneNode helper;
      helper.name = unique_name(node.name + "$shear");
      helper.parent = parent;
      helper.parent_from_node = parts.outer;
      parent = push(std::move(helper));
      node.parent_from_node = parts.inner;
      notes.inform(place, "transform has shear; written as two nodes");
    }
  }
  node.parent = parent;
  const std::uint32_t index = push(std::move(node));
  node_of_source_.emplace(&source, index);
  if (!node_of_name_.emplace(source_name, index).second && !source_name.empty() &&
      animated_.contains(source_name))
    notes.inform("node '" + readable + "'",
                 "animated or skinned by an ambiguous name; the first node of that name is taken");
  return index;
}

std::uint32_t SceneTree::push(SceneNode node) {
  node.model_from_node = matrix_of(node.parent_from_node);
  if (node.parent != kNone)
    node.model_from_node = nodes_[node.parent].model_from_node * node.model_from_node;
  nodes_.push_back(std::move(node));
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::string SceneTree::unique_name(const std::string& wanted) {
  if (wanted.empty() || names_.insert(wanted).second) return wanted;
  for (std::uint32_t& number = name_uses_[wanted];;) {
    std::string candidate = wanted + "_" + std::to_string(++number + 1);
    if (names_.insert(candidate).second) return candidate;
  }
}

std::uint32_t SceneTree::find(const aiString& name) const {
  const auto found = node_of_name_.find(to_string(name));
  return found == node_of_name_.end() ? kNone : found->second;
}

std::uint32_t SceneTree::find_bone(std::uint32_t mesh_node, const aiString& bone) const {
  const auto joint = joints_.find({nodes_[mesh_node].source, to_string(bone)});
  return joint == joints_.end() ? find(bone) : node_of_source_.at(joint->second);
}

std::uint32_t SceneTree::add(std::uint32_t parent, const std::string& name,
                             const Mat4d& parent_from_node, const aiString* source_name) {
  SceneNode node;
  node.name = unique_name(name);
  node.parent = parent;
  node.parent_from_node = decompose(parent_from_node);
  const std::uint32_t index = push(std::move(node));
  if (source_name != nullptr) node_of_name_.emplace(to_string(*source_name), index);
  return index;
}

void SceneTree::write(GlbBuilder& glb) const {
  Json nodes = Json::array();
  for (const SceneNode& node : nodes_) {
    Json json = Json::object();
    if (!node.name.empty()) json["name"] = node.name;
    write_transform(node.parent_from_node, json);
    json.update(node.json);
    nodes.push_back(std::move(json));
  }
  Json roots = Json::array();
  for (std::uint32_t i = 0; i < nodes_.size(); ++i)
    (nodes_[i].parent == kNone ? roots : nodes[nodes_[i].parent]["children"]).push_back(i);
  glb.document["scene"] = 0;
  glb.document["scenes"] = {{{"nodes", std::move(roots)}}};
  glb.document["nodes"] = std::move(nodes);
}

}  // namespace sunder::assimp_import
