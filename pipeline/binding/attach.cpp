#include "pipeline/binding/attach.h"

#include <sunder/weights/influences.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/internal/ordered.h"

namespace sunder::binding {
namespace {

constexpr double kSumsToOne = 1e-7;  ///< Times the number of weights; half of what is allowed.

/// The clips of the rig without channels of morph weights, which belong to the rig's own meshes.
std::vector<Clip> bone_clips(const std::vector<Clip>& clips) {
  std::vector<Clip> kept;
  for (const Clip& clip : clips) {
    Clip bones{clip.name, 0.0f, {}};
    for (const Channel& channel : clip.channels) {
      if (channel.target == ChannelTarget::morph_weights) continue;
      bones.duration = std::max(bones.duration, channel.times.back());
      bones.channels.push_back(channel);
    }
    if (!bones.channels.empty()) kept.push_back(std::move(bones));
  }
  return kept;
}

/// The new skins: per mesh, and the skin of the model that each stands for.
struct SharedSkins {
  std::vector<Index> of_mesh;
  std::vector<Index> model_skin;
};

SharedSkins share_skins(const Joined& joined, bool joins) {
  SharedSkins shared;
  for (const Mesh& mesh : joined.model.meshes) {
    const auto known = std::ranges::find_if(shared.model_skin, [&](Index other) {
      return other == mesh.skin || (joins && joined.rig_from_bind[other].matrix() ==
                                                 joined.rig_from_bind[mesh.skin].matrix());
    });
    shared.of_mesh.push_back(static_cast<Index>(known - shared.model_skin.begin()));
    if (known == shared.model_skin.end()) shared.model_skin.push_back(mesh.skin);
  }
  return shared;
}

Result<Skin> make_skin(const Joined& joined, const std::map<Index, Index>& slot_of_bone,
                       Index model_skin) {
  Skin skin;
  skin.name = joined.model.skins[model_skin].name;
  for (const auto& [bone, slot] : slot_of_bone) {
    const Affine3d bone_from_bind =
        multiply(inverse(joined.rig_from_bone[bone]), joined.rig_from_bind[model_skin]);
    skin.bones.push_back(bone);
    skin.bone_from_bind.push_back(Affine3f(bone_from_bind.cast<float>()));
    if (!skin.bone_from_bind.back().matrix().allFinite())
      return Status::failure(StatusCode::invalid_argument, bone,
                             "the pose of the rig: bone %u '%.80s' has no inverse", bone,
                             joined.rig.skeleton.bones[bone].name.c_str());
  }
  return skin;
}

std::vector<Influence> influences_of(const WeightRow& row,
                                     const std::map<Index, Index>& slot_of_bone) {
  double sum = 0;
  for (const BoneWeight& entry : row) sum += entry.weight;
  if (std::abs(sum - 1) <= kSumsToOne * static_cast<double>(row.size())) sum = 1;  // keeps the bits
  std::vector<Influence> influences;
  for (const BoneWeight& entry : row)
    if (const auto weight = static_cast<float>(entry.weight / sum); weight > 0.0f)
      influences.push_back({slot_of_bone.at(entry.bone), weight});
  (void)sort_influences(influences);
  return influences;
}

}  // namespace

Result<Binding> attach(const Joined& joined, const std::vector<std::vector<WeightRow>>& rows,
                       bool joins) {
  Binding binding;
  Character& character = binding.character;
  character.name = joined.model.name;
  character.skeleton = joined.rig.skeleton;
  character.meshes = joined.model.meshes;
  character.rest_morph_weights = joined.model.rest_morph_weights;
  character.clips = bone_clips(joined.rig.clips);
  binding.clips_left_out = static_cast<std::uint32_t>(joined.model.clips.size());
  binding.largest_shape_error = joined.largest_shape_error;

  const SharedSkins shared = share_skins(joined, joins);
  std::vector<std::map<Index, Index>> slot_of_bone(shared.model_skin.size());
  for (Index m = 0; m < rows.size(); ++m)
    for (const WeightRow& row : rows[m])
      for (const BoneWeight& entry : row)
        slot_of_bone[shared.of_mesh[m]].try_emplace(entry.bone, 0);
  for (Index s = 0; s < slot_of_bone.size(); ++s) {
    if (slot_of_bone[s].empty()) slot_of_bone[s].try_emplace(0, 0);  // of meshes without vertices
    Index slot = 0;
    for (auto& [bone, number] : slot_of_bone[s]) number = slot++;
    Result<Skin> skin = make_skin(joined, slot_of_bone[s], shared.model_skin[s]);
    if (!skin) return skin.error();
    character.skins.push_back(std::move(*skin));
  }
  for (Index m = 0; m < rows.size(); ++m) {
    Mesh& mesh = character.meshes[m];
    mesh.skin = shared.of_mesh[m];
    mesh.weights = {};
    for (const WeightRow& row : rows[m])
      mesh.weights.append(influences_of(row, slot_of_bone[mesh.skin]));
  }
  return binding;
}

}  // namespace sunder::binding
