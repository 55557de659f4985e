#include "tools/transfer/copy_clips.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace sunder::tools {
namespace {

/// Parts of a rest transform that differ by less are equal, relative to the model's size for
/// translations.
constexpr float kSameRest = 1e-3f;

bool has_same_rest(const BoneTransform& a, const BoneTransform& b, float size) {
  return (a.translation - b.translation).norm() <= kSameRest * size &&
         std::abs(a.rotation.dot(b.rotation)) >= 1 - kSameRest &&
         (a.scale - b.scale).norm() <= kSameRest;
}

float size_of(const Character& character) {
  float most = 0;
  for (const Bone& bone : character.skeleton.bones)
    most = std::max(most, bone.rest.translation.norm());
  return most;
}

/// A name that no clip has: "Walk", or "Walk 2".
std::string free_name(const std::string& wanted, const std::vector<Clip>& clips) {
  const auto is_taken = [&](const std::string& name) {
    return std::ranges::find(clips, name, &Clip::name) != clips.end();
  };
  std::string name = wanted;
  for (int number = 2; is_taken(name); ++number) name = wanted + " " + std::to_string(number);
  return name;
}

}  // namespace

Result<std::size_t> copy_clips(const Character& source, TransferResult& result) {
  const float size = std::max(size_of(source), size_of(result.character));
  std::vector<Clip> copied;
  for (const Clip& clip : source.clips) {
    Clip copy{clip.name, clip.duration, {}};
    for (const Channel& channel : clip.channels) {
      if (channel.target == ChannelTarget::morph_weights) continue;
      const Bone& bone = source.skeleton.bones[channel.index];
      const std::uint32_t counterpart = result.bone_of_source[channel.index];
      if (counterpart >= result.character.skeleton.bones.size()) continue;  // also in a dry run
      const Bone& own = result.character.skeleton.bones[counterpart];
      if (!has_same_rest(bone.rest, own.rest, size))
        return Status::failure(StatusCode::invalid_argument, counterpart,
                               "bone '%.60s' of the target rests otherwise than '%.60s' of the "
                               "source, so clip '%.60s' would bend it wrongly",
                               own.name.c_str(), bone.name.c_str(), clip.name.c_str());
      copy.channels.push_back(channel);
      copy.channels.back().index = counterpart;
    }
    if (!copy.channels.empty()) copied.push_back(std::move(copy));
  }
  for (Clip& clip : copied) {
    clip.name = free_name(clip.name, result.character.clips);
    result.character.clips.push_back(std::move(clip));
  }
  return copied.size();
}

}  // namespace sunder::tools
