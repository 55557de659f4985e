#include "io/gltf_write/rig_writer.h"

#include <utility>

#include "io/gltf/accessors.h"
#include "io/gltf_write/lists.h"

namespace sunder::gltf {
Json bone_node(const Bone& bone) {
  Json node = {{"name", bone.name}};
  const BoneTransform& rest = bone.rest;
  if (!rest.translation.isZero(0)) node["translation"] = numbers_of({rest.translation.data(), 3});
  const Quatf rotation = rest.rotation.normalized();
  if (rotation.coeffs() != Quatf::Identity().coeffs())
    node["rotation"] = numbers_of({rotation.coeffs().data(), 4});
  if (rest.scale != Vec3f::Ones()) node["scale"] = numbers_of({rest.scale.data(), 3});
  return node;
}

std::uint32_t add_bind_matrices(GlbDraft& draft, const Skin& skin) {
  std::vector<float> matrices;
  for (const Affine3f& bone_from_bind : skin.bone_from_bind) {
    const Eigen::Matrix4f full = Eigen::Transform<float, 3, Eigen::Affine>(bone_from_bind).matrix();
    matrices.insert(matrices.end(), full.data(), full.data() + 16);
  }
  const std::uint32_t view =
      draft.add_view(std::as_bytes(std::span<const float>(matrices)), GlbDraft::ViewTarget::none);
  return append(draft.json, "accessors",
                {{"bufferView", view},
                 {"componentType", static_cast<std::uint32_t>(ComponentType::f32)},
                 {"count", skin.bones.size()},
                 {"type", "MAT4"}});
}

std::uint32_t add_skin(GlbDraft& draft, const Skin& skin,
                       std::span<const std::uint32_t> node_of_bone) {
  Json joints = Json::array();
  for (const std::uint32_t bone : skin.bones) joints.push_back(node_of_bone[bone]);
  Json gltf_skin = {{"inverseBindMatrices", add_bind_matrices(draft, skin)},
                    {"joints", std::move(joints)}};
  if (!skin.name.empty()) gltf_skin["name"] = skin.name;
  return append(draft.json, "skins", std::move(gltf_skin));
}

AppendedRig::AppendedRig(GlbDraft& draft, const Character& character, const SourceDocument& source,
                         std::uint32_t first_bone)
    : draft_(draft),
      character_(character),
      node_of_bone_(source.node_of_bone),
      gltf_skin_of_(character.skins.size(), kNone) {
  const auto& bones = character.skeleton.bones;
  std::vector<std::uint32_t> roots;
  node_of_bone_.resize(bones.size(), kNone);
  for (std::uint32_t bone = first_bone; bone < bones.size(); ++bone) {
    const std::uint32_t node = append(draft.json, "nodes", bone_node(bones[bone]));
    node_of_bone_[bone] = node;
    if (bones[bone].parent == kNone) {
      roots.push_back(node);
      continue;
    }
    Json& children = draft.json["nodes"][node_of_bone_[bones[bone].parent]]["children"];
    if (children.is_null()) children = Json::array();
    children.push_back(node);
  }
  if (roots.size() > 1)
    roots = {append(draft.json, "nodes", {{"name", "Skeleton"}, {"children", roots}})};
  if (!roots.empty()) add_to_scene(roots);
}

/// Without scenes, all nodes without a parent are shown.
void AppendedRig::add_to_scene(const std::vector<std::uint32_t>& roots) {
  const auto scenes = draft_.json.find("scenes");
  if (scenes == draft_.json.end() || scenes->empty()) return;
  const auto chosen = draft_.json.find("scene");
  Json& scene = (*scenes)[chosen == draft_.json.end() ? 0 : chosen->get<std::size_t>()];
  Json& nodes = scene["nodes"];
  if (nodes.is_null()) nodes = Json::array();
  for (const std::uint32_t root : roots) nodes.push_back(root);
}

std::uint32_t AppendedRig::skin(std::uint32_t index) {
  std::uint32_t& gltf_skin = gltf_skin_of_[index];
  if (gltf_skin == kNone) gltf_skin = add_skin(draft_, character_.skins[index], node_of_bone_);
  return gltf_skin;
}

}  // namespace sunder::gltf
