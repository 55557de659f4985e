#include "io/gltf_patch/clip_patch.h"

#include <map>
#include <string>
#include <utility>

#include "io/gltf/decompose.h"
#include "io/gltf/refusal.h"
#include "io/gltf_write/clip_writer.h"

namespace sunder::gltf {

ClipPatch::ClipPatch(GlbDraft& draft, const Character& character, const SourceDocument& source,
                     std::span<const std::uint32_t> node_of_bone)
    : draft_(draft), character_(character), source_(source), node_of_bone_(node_of_bone) {}

void ClipPatch::write_changed(const Character& before) {
  for (std::uint32_t i = 0; i < character_.clips.size(); ++i) {
    const Clip& clip = character_.clips[i];
    const bool is_new = i >= before.clips.size();
    if (!is_new && clip == before.clips[i]) continue;
    for (std::uint32_t channel = 0; channel < clip.channels.size(); ++channel)
      prepare_target(clip, channel);
    Json animation = animation_of(clip, is_new ? Json() : draft_.json["animations"][i]);
    if (!animation.is_null() && (is_new || clip.name != before.clips[i].name)) {
      animation.erase("name");
      if (!clip.name.empty()) animation["name"] = clip.name;
    }
    // Animations without a channel stay null until the end, so that clips keep their indices.
    if (is_new)
      list_of(draft_.json, "animations").push_back(std::move(animation));
    else
      draft_.json["animations"][i] = std::move(animation);
  }
}

/// Makes a channel's target one that glTF can animate.
void ClipPatch::prepare_target(const Clip& clip, std::uint32_t index) {
  const Channel& channel = clip.channels[index];
  if (channel.target == ChannelTarget::morph_weights) {
    for (const Mesh& mesh : character_.meshes)
      if (mesh.first_morph_weight == channel.index && mesh.morph_targets.size() == channel.width)
        return;
    refuse(StatusCode::invalid_argument, index,
           "save_glb: clip '%.60s', channel %u: morph weights %u to %u are not those of a mesh",
           clip.name.c_str(), index, channel.index, channel.index + channel.width - 1);
  }
  if (channel.index >= node_of_bone_.size() || node_of_bone_[channel.index] == kNone)
    refuse(StatusCode::invalid_argument, index,
           "save_glb: clip '%.60s', channel %u: bone '%.60s' has no node in the file",
           clip.name.c_str(), index, character_.skeleton.bones[channel.index].name.c_str());
  if (draft_.json["nodes"][node_of_bone_[channel.index]].contains("matrix"))
    replace_matrix(clip, index);
}

void ClipPatch::replace_matrix(const Clip& clip, std::uint32_t index) {
  const std::uint32_t bone = clip.channels[index].index;
  Json& node = draft_.json["nodes"][node_of_bone_[bone]];
  Affine3d matrix;
  for (std::size_t i = 0; i < 12; ++i)
    matrix.matrix()(static_cast<Eigen::Index>(i % 3), static_cast<Eigen::Index>(i / 3)) =
        static_cast<double>(node["matrix"][i / 3 * 4 + i % 3].get<float>());
  if (decompose(matrix).second)
    refuse(
        StatusCode::invalid_argument, index,
        "save_glb: clip '%.60s', channel %u: the node of bone '%.60s' is sheared, so glTF cannot "
        "animate it",
        clip.name.c_str(), index, character_.skeleton.bones[bone].name.c_str());
  node.erase("matrix");
  // As loading took it from the matrix, so that the bone keeps its bits.
  const BoneTransform& rest = character_.skeleton.bones[bone].rest;
  const auto write = [&](const char* key, std::span<const float> values) {
    for (const float value : values) node[key].push_back(static_cast<double>(value));
  };
  write("translation", {rest.translation.data(), 3});
  write("rotation", {rest.rotation.coeffs().data(), 4});
  write("scale", {rest.scale.data(), 3});
}

/// The node that a channel moves; kNone if it has none any more.
std::uint32_t ClipPatch::node_of(const Channel& channel) const {
  if (channel.target == ChannelTarget::morph_weights) return node_of_weights(channel);
  if (channel.index >= node_of_bone_.size()) return kNone;
  const std::uint32_t node = node_of_bone_[channel.index];
  return node == kNone || draft_.json["nodes"][node].contains("matrix") ? kNone : node;
}

std::uint32_t ClipPatch::node_of_weights(const Channel& channel) const {
  for (std::size_t mesh = 0; mesh < character_.meshes.size(); ++mesh) {
    const Mesh& morphed = character_.meshes[mesh];
    const std::uint32_t node = source_.mesh_origins[mesh].node;
    if (!morphed.morph_targets.empty() && morphed.first_morph_weight == channel.index &&
        draft_.json["nodes"][node].contains("mesh"))
      return node;
  }
  return kNone;
}

Json ClipPatch::animation_of(const Clip& clip, const Json& old) {
  constexpr const char* kPaths[] = {"translation", "rotation", "scale", "weights"};
  Json animation = old.is_object() ? old : Json::object();
  animation["channels"] = Json::array();
  animation["samplers"] = Json::array();
  std::map<std::pair<std::uint32_t, std::string>, std::size_t> channel_of;
  for (const Channel& channel : clip.channels) {
    const std::uint32_t node = node_of(channel);
    if (node == kNone) continue;
    const bool is_rotation = channel.target == ChannelTarget::rotation;
    const bool is_morph = channel.target == ChannelTarget::morph_weights;
    const std::uint32_t components = is_rotation ? 4 : is_morph ? 1 : 3;
    animation["samplers"].push_back(
        is_rotation ? add_sampler(draft_, channel, unit_rotations(channel), components)
                    : add_sampler(draft_, channel, channel.values, components));
    const char* const path = kPaths[static_cast<std::size_t>(channel.target)];
    Json written = {{"sampler", animation["samplers"].size() - 1},
                    {"target", {{"node", node}, {"path", path}}}};
    // The last one of several channels with the same target applies, as in a pose; glTF allows only
    // one.
    const auto [found, is_new] = channel_of.try_emplace({node, path}, animation["channels"].size());
    if (is_new)
      animation["channels"].push_back(std::move(written));
    else
      animation["channels"][found->second] = std::move(written);
  }
  return animation["channels"].empty() ? Json() : animation;
}

}  // namespace sunder::gltf
