#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <assimp/scene.h>

#include "io/assimp/glb_builder.h"
#include "io/assimp/model_space.h"
#include "io/assimp/notes.h"

namespace sunder::assimp_import {

/// The node of a bone, by the node that shows its mesh and by the bone's name. Bones without an
/// entry are found by their names alone.
using JointNodes = std::map<std::pair<const aiNode*, std::string>, const aiNode*>;

struct SceneNode {
  std::string name;              ///< UTF-8, unique or empty.
  std::uint32_t parent = kNone;  ///< Smaller than the node's own index.
  Trs parent_from_node;
  Mat4d model_from_node = Mat4d::Identity();  ///< In the file's rest pose.
  const aiNode* source = nullptr;             ///< Null for nodes that the import added.
  Json json = Json::object();  ///< Properties that converters add: mesh, skin, extras.
};

/// All nodes of the scene, parents first. If necessary, the root transforms the file's space to
/// model space.
class SceneTree {
 public:
  /// Throws ImportFailure (limit_exceeded) if the tree has more than 1024 levels.
  SceneTree(const aiScene& scene, const ModelSpace& space, JointNodes joints, Notes& notes);

  [[nodiscard]] const std::vector<SceneNode>& nodes() const { return nodes_; }
  SceneNode& operator[](std::uint32_t node) { return nodes_[node]; }
  [[nodiscard]] const SceneNode& operator[](std::uint32_t node) const { return nodes_[node]; }

  /// The node that assimp identifies by a name: the first one in the file's order. kNone if there
  /// is none.
  [[nodiscard]] std::uint32_t find(const aiString& name) const;
  /// The node of a bone of a mesh: by the joints that were given, otherwise by its name.
  [[nodiscard]] std::uint32_t find_bone(std::uint32_t mesh_node, const aiString& bone) const;
  /// Adds a node. Its name is made unique; `source_name`, if given, is the name by which it is
  /// found.
  std::uint32_t add(std::uint32_t parent, const std::string& name, const Mat4d& parent_from_node,
                    const aiString* source_name = nullptr);

  void write(GlbBuilder& glb) const;

 private:
  std::uint32_t add_node(const aiNode& source, std::uint32_t parent, Notes& notes);
  std::uint32_t push(SceneNode node);
  std::string unique_name(const std::string& wanted);

  JointNodes joints_;
  std::vector<SceneNode> nodes_;
  /// Key: the name's bytes in the file.
  std::unordered_map<std::string, std::uint32_t> node_of_name_;
  std::unordered_map<const aiNode*, std::uint32_t> node_of_source_;
  std::unordered_set<std::string> names_;
  std::unordered_map<std::string, std::uint32_t> name_uses_;
  std::unordered_set<std::string> animated_;
};

[[nodiscard]] std::string to_string(const aiString& text);

}  // namespace sunder::assimp_import
