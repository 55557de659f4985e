#include "io/assimp/collada_joints.h"

#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "io/collada/scene.h"
#include "io/files/read_at.h"

namespace sunder::assimp_import {
namespace {

/// The name that assimp gives to a node; empty if it invents one.
const std::string& name_in_assimp(const collada::Node& node) {
  return node.id.empty() ? node.sid : node.id;
}

/// The nodes that assimp takes for joints, and by which it names the bones.
class TakenByAssimp {
 public:
  explicit TakenByAssimp(const collada::Scene& scene) {
    for (std::uint32_t node = 0; node < scene.nodes.size(); ++node) {
      by_name_or_id_.emplace(scene.nodes[node].name, node);
      by_name_or_id_.emplace(scene.nodes[node].id, node);
      by_sid_.emplace(scene.nodes[node].sid, node);
    }
  }

  [[nodiscard]] std::uint32_t node_of(const std::string& joint) const {
    for (const auto* const nodes : {&by_name_or_id_, &by_sid_})
      if (const auto found = nodes->find(joint); found != nodes->end()) return found->second;
    return kNone;
  }

 private:
  std::unordered_map<std::string_view, std::uint32_t> by_name_or_id_, by_sid_;
};

/// The names that assimp gives to the bones of a skin, one per joint.
std::vector<std::string> bone_names(const collada::SkinInstance& skin, const collada::Scene& scene,
                                    const TakenByAssimp& taken) {
  std::vector<std::string> names;
  for (const std::string& joint : skin.joints) {
    const std::uint32_t node = taken.node_of(joint);
    names.push_back(node == kNone ? joint : name_in_assimp(scene.nodes[node]));
  }
  return names;
}

/// assimp's node of each node of the file; children come in the file's order, then instances.
/// @throws std::runtime_error if these are not the nodes of the file.
std::vector<const aiNode*> match_all(const aiNode& root, const collada::Scene& scene) {
  std::vector<const aiNode*> all(scene.nodes.size(), nullptr);
  all[0] = &root;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const collada::Node& node = scene.nodes[i];
    const std::string& name = name_in_assimp(node);
    if ((!name.empty() && to_string(all[i]->mName) != name) ||
        all[i]->mNumChildren < node.children.size())
      throw std::runtime_error("the importer's nodes are not those of the file");
    for (std::size_t k = 0; k < node.children.size(); ++k)
      all[node.children[k]] = all[i]->mChildren[k];
  }
  return all;
}

std::string content_of(const ModelFile& model) {
  std::string text(model.file.bytes, '\0');
  text.resize(files::read_at(model.file.descriptor, text.data(), text.size(), 0));
  return text;
}

JointNodes joints_of(const collada::Scene& file, const aiNode& root) {
  const std::vector<const aiNode*> node_of = match_all(root, file);
  const TakenByAssimp taken(file);
  JointNodes joints;
  for (std::size_t i = 0; i < file.nodes.size(); ++i)
    for (const collada::SkinInstance& skin : file.nodes[i].skins) {
      const std::vector<std::string> bones = bone_names(skin, file, taken);
      const std::vector<std::uint32_t> nodes = collada::find_joints(file, skin);
      for (std::size_t k = 0; k < nodes.size(); ++k)
        if (nodes[k] != kNone) joints.emplace(std::pair{node_of[i], bones[k]}, node_of[nodes[k]]);
    }
  return joints;
}

}  // namespace

JointNodes collada_joints(const aiScene& scene, const ModelFile& model, Notes& notes) {
  try {
    return joints_of(collada::read_scene(content_of(model)), *scene.mRootNode);
  } catch (const std::runtime_error& error) {
    notes.inform("file", std::string("joints are found by their names alone: ") + error.what());
    return {};
  }
}

}  // namespace sunder::assimp_import
