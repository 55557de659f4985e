#include "io/assimp/convert_meshes.h"

#include <algorithm>
#include <map>
#include <utility>

#include "io/assimp/bone_binding.h"
#include "io/assimp/mesh_part.h"
#include "io/assimp/normals.h"
#include "io/assimp/skin_check.h"
#include "io/assimp/skin_weights.h"
#include "io/assimp/weld.h"

namespace sunder::assimp_import {
namespace {

std::vector<std::string> morph_names(const aiMesh& mesh) {
  std::vector<std::string> names;
  for (unsigned i = 0; i < mesh.mNumAnimMeshes; ++i)
    if (mesh.mAnimMeshes[i] != nullptr)
      names.push_back(valid_utf8(to_string(mesh.mAnimMeshes[i]->mName)));
  return names;
}

/// Meshes of one node that can form one glTF mesh: all rigid or all on one skin, with the same
/// morph targets.
struct Group {
  bool is_skinned = false;
  std::vector<std::string> targets;
  std::map<std::uint32_t, Mat4f> bone_from_mesh_of_node;
  std::vector<std::pair<std::uint32_t, std::vector<BoneBinding>>>
      meshes;  ///< Index of the aiMesh, and its bones.

  [[nodiscard]] bool accepts(bool skinned, const std::vector<std::string>& wanted_targets,
                             const std::vector<BoneBinding>& bones) const {
    if (skinned != is_skinned || wanted_targets != targets) return false;
    return std::all_of(bones.begin(), bones.end(), [&](const BoneBinding& bone) {
      const auto known = bone_from_mesh_of_node.find(bone.node);
      return known == bone_from_mesh_of_node.end() || known->second == bone.bone_from_mesh;
    });
  }
};

class Converter {
 public:
  Converter(const aiScene& scene, const std::vector<bool>& is_de_indexed,
            const std::string& extension, SceneTree& tree, MaterialWriter& materials,
            GlbBuilder& glb, Notes& notes)
      : scene_(scene),
        is_de_indexed_(is_de_indexed),
        extension_(extension),
        tree_(tree),
        materials_(materials),
        glb_(glb),
        notes_(notes) {}

  std::vector<MorphedNode> convert_all() {
    const auto count = static_cast<std::uint32_t>(tree_.nodes().size());
    for (std::uint32_t node = 0; node < count; ++node) {
      if (tree_[node].source == nullptr) continue;
      bool is_first = true;
      for (const Group& group : groups_of(node)) {
        const std::uint32_t carrier =
            is_first ? node : tree_.add(node, tree_[node].name + "_mesh", Mat4d::Identity());
        if (convert(group, carrier, node)) is_first = false;
      }
    }
    return std::move(morphed_);
  }

 private:
  [[nodiscard]] std::string place_of(std::uint32_t mesh) const {
    return "mesh " + std::to_string(mesh) + " '" +
           valid_utf8(to_string(scene_.mMeshes[mesh]->mName)) + "'";
  }

  std::vector<Group> groups_of(std::uint32_t node) {
    std::vector<Group> groups;
    const aiNode& source = *tree_[node].source;
    for (unsigned i = 0; i < source.mNumMeshes; ++i) {
      const std::uint32_t index = source.mMeshes[i];
      if (index >= scene_.mNumMeshes || scene_.mMeshes[index] == nullptr) continue;
      const aiMesh& mesh = *scene_.mMeshes[index];
      std::vector<BoneBinding> bones;
      if (mesh.mNumBones > 0 && mesh.mBones != nullptr)
        bones = bind_bones(mesh, node, place_of(index), tree_, notes_);
      std::erase_if(bones, [](const BoneBinding& bone) { return bone.node == kNone; });
      const bool is_skinned = !bones.empty();
      std::vector<std::string> targets = morph_names(mesh);

      auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& one) {
        return one.accepts(is_skinned, targets, bones);
      });
      if (group == groups.end()) {
        groups.push_back({.is_skinned = is_skinned,
                          .targets = std::move(targets),
                          .bone_from_mesh_of_node = {},
                          .meshes = {}});
        group = groups.end() - 1;
      }
      for (const BoneBinding& bone : bones)
        group->bone_from_mesh_of_node.emplace(bone.node, bone.bone_from_mesh);
      group->meshes.emplace_back(index, std::move(bones));
    }
    return groups;
  }

  ///
  /// @return whether the node has a mesh now.
  bool convert(const Group& group, std::uint32_t carrier, std::uint32_t source_node) {
    SkinSlots slots;
    for (const auto& [node, bone_from_mesh] : group.bone_from_mesh_of_node) {
      slots.nodes.push_back(node);
      slots.bone_from_mesh.push_back(bone_from_mesh);
    }
    const std::uint32_t skin = group.is_skinned ? skin_of(slots) : kNone;
    std::vector<std::uint32_t> key = {skin};
    for (const auto& [mesh, bones] : group.meshes) key.push_back(mesh);
    if (const auto known = mesh_of_sources_.find(key); known != mesh_of_sources_.end()) {
      if (known->second == kNone) return false;
      if (skin != kNone) {
        // A skin ignores the transform of its node, so this instance would coincide with the first.
        notes_.dropped(StatusCode::unsupported_feature, "node '" + tree_[carrier].name + "'",
                       "a second instance of a skinned mesh");
        return false;
      }
      tree_[carrier].json["mesh"] = known->second;
      add_morphed(group, carrier, source_node);
      return true;
    }

    std::vector<MeshPart> parts = read_parts(group, slots);
    if (parts.empty()) {
      mesh_of_sources_.emplace(std::move(key), kNone);
      return false;
    }
    generate_missing_normals(parts, notes_);
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (is_de_indexed_[part_mesh_[i]]) weld_identical(parts[i]);
    if (group.is_skinned)
      check_skin(slots, parts, source_node, place_of(part_mesh_[0]), tree_, notes_);

    const std::uint32_t mesh = write_mesh(group, parts, slots);
    tree_[carrier].json["mesh"] = mesh;
    if (skin != kNone) tree_[carrier].json["skin"] = skin;
    add_morphed(group, carrier, source_node);
    mesh_of_sources_.emplace(std::move(key), mesh);
    return true;
  }

  std::vector<MeshPart> read_parts(const Group& group, const SkinSlots& slots) {
    std::vector<MeshPart> parts;
    part_mesh_.clear();
    for (const auto& [index, bones] : group.meshes) {
      const aiMesh& mesh = *scene_.mMeshes[index];
      MeshPart part = read_part(mesh, place_of(index), notes_);
      if (part.triangles.empty()) continue;
      if (group.is_skinned) {
        std::vector<std::uint32_t> slot_of_bone(mesh.mNumBones, kNone);
        std::size_t next = 0;
        for (unsigned b = 0; b < mesh.mNumBones; ++b) {
          if (mesh.mBones[b] == nullptr) continue;  // Such bones have no binding.
          const auto slot =
              std::lower_bound(slots.nodes.begin(), slots.nodes.end(), bones[next++].node);
          slot_of_bone[b] = static_cast<std::uint32_t>(slot - slots.nodes.begin());
        }
        part.weights = read_weights(mesh, slot_of_bone, part.place, notes_);
      }
      parts.push_back(std::move(part));
      part_mesh_.push_back(index);
    }
    return parts;
  }

  std::uint32_t skin_of(const SkinSlots& slots) {
    for (std::uint32_t i = 0; i < skins_.size(); ++i)
      if (skins_[i].nodes == slots.nodes && skins_[i].bone_from_mesh == slots.bone_from_mesh)
        return i;
    skins_.push_back(slots);
    return glb_.append("skins", {{"inverseBindMatrices", glb_.add_matrices(slots.bone_from_mesh)},
                                 {"joints", slots.nodes}});
  }

  std::uint32_t write_mesh(const Group& group, std::vector<MeshPart>& parts,
                           const SkinSlots& slots) {
    Json mesh = Json::object();
    const std::string name = valid_utf8(to_string(scene_.mMeshes[part_mesh_[0]]->mName));
    if (!name.empty()) mesh["name"] = name;
    for (MeshPart& part : parts)
      mesh["primitives"].push_back(write_primitive(part, group.targets.size(), slots.nodes.size()));
    if (!group.targets.empty()) {
      mesh["weights"] = default_weights(*scene_.mMeshes[part_mesh_[0]]);
      mesh["extras"]["targetNames"] = group.targets;
    }
    return glb_.append("meshes", std::move(mesh));
  }

  Json write_primitive(const MeshPart& part, std::size_t target_count, std::size_t joint_count) {
    Json primitive = {{"attributes", Json::object()}};
    if (target_count > 0) primitive["targets"] = Json(target_count, Json::object());
    for (const Stream& stream : part.streams) {
      Json& attributes =
          stream.target == kNone ? primitive["attributes"] : primitive["targets"][stream.target];
      attributes[stream.semantic] =
          glb_.add_floats(stream.values, stream.components, GlbBuilder::Use::vertex_attribute,
                          stream.semantic == "POSITION");
    }
    if (joint_count > 0) write_weights(part, joint_count, primitive["attributes"]);
    std::vector<std::uint32_t> indices;
    indices.reserve(part.triangles.size() * 3);
    for (const Triangle& triangle : part.triangles)
      indices.insert(indices.end(), triangle.begin(), triangle.end());
    primitive["indices"] = glb_.add_indices(indices);
    if (const auto material = materials_.material_for(part.material, part.texcoord_of_channel))
      primitive["material"] = *material;
    return primitive;
  }

  /// JOINTS_n and WEIGHTS_n, four influences each, as many sets as the largest vertex needs.
  void write_weights(const MeshPart& part, std::size_t joint_count, Json& attributes) {
    const std::uint32_t count = part.weights.vertex_count();
    std::size_t most = 1;
    for (std::uint32_t v = 0; v < count; ++v) most = std::max(most, part.weights.of(v).size());
    for (std::size_t set = 0; set * 4 < most; ++set) {
      std::vector<std::uint16_t> joints(std::size_t{count} * 4, 0);
      std::vector<float> weights(std::size_t{count} * 4, 0.0f);
      for (std::uint32_t v = 0; v < count; ++v) {
        const auto influences = part.weights.of(v);
        for (std::size_t k = set * 4; k < std::min(influences.size(), set * 4 + 4); ++k) {
          joints[std::size_t{v} * 4 + k % 4] = static_cast<std::uint16_t>(influences[k].slot);
          weights[std::size_t{v} * 4 + k % 4] = influences[k].weight;
        }
      }
      const std::string number = std::to_string(set);
      attributes["JOINTS_" + number] = glb_.add_joints(joints, joint_count);
      attributes["WEIGHTS_" + number] =
          glb_.add_floats(weights, 4, GlbBuilder::Use::vertex_attribute);
    }
  }

  Json default_weights(const aiMesh& mesh) {
    Json weights = Json::array();
    for (unsigned i = 0; i < mesh.mNumAnimMeshes; ++i) {
      if (mesh.mAnimMeshes[i] == nullptr) continue;
      // assimp's FBX loader returns 1 for most channels, whatever the file says; FBX files have 0
      // at rest.
      const float weight = extension_ == "fbx" ? 0.0f : mesh.mAnimMeshes[i]->mWeight;
      weights.push_back(std::isfinite(weight) ? static_cast<double>(weight) : 0.0);
    }
    if (extension_ == "fbx")
      notes_.inform(place_of(part_mesh_[0]),
                    "default morph weights are not imported; taken as zero");
    return weights;
  }

  void add_morphed(const Group& group, std::uint32_t carrier, std::uint32_t source_node) {
    if (group.targets.empty()) return;
    morphed_.push_back({carrier, to_string(tree_[source_node].source->mName),
                        static_cast<std::uint32_t>(group.targets.size())});
  }

  const aiScene& scene_;
  const std::vector<bool>& is_de_indexed_;
  const std::string& extension_;
  SceneTree& tree_;
  MaterialWriter& materials_;
  GlbBuilder& glb_;
  Notes& notes_;

  std::vector<SkinSlots> skins_;  ///< As written.
  std::map<std::vector<std::uint32_t>, std::uint32_t>
      mesh_of_sources_;  ///< glTF mesh by skin and aiMeshes; kNone: nothing to draw.
  std::vector<std::uint32_t> part_mesh_;  ///< Index of the aiMesh of each current part.
  std::vector<MorphedNode> morphed_;
};

}  // namespace

std::vector<MorphedNode> convert_meshes(const aiScene& scene,
                                        const std::vector<bool>& is_de_indexed,
                                        const std::string& extension, SceneTree& tree,
                                        MaterialWriter& materials, GlbBuilder& glb, Notes& notes) {
  return Converter(scene, is_de_indexed, extension, tree, materials, glb, notes).convert_all();
}

}  // namespace sunder::assimp_import
