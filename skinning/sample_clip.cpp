#include <sunder/skinning/pose.h>

#include <cmath>
#include <cstdint>

#include "core/internal/out_of_memory.h"
#include "skinning/internal/sample_channel.h"

namespace sunder {

Result<Pose> local_rest_pose(const Character& character) {
  return or_out_of_memory([&]() -> Result<Pose> {
    Pose pose;
    pose.parent_from_bone.reserve(character.skeleton.bones.size());
    for (const Bone& bone : character.skeleton.bones) pose.parent_from_bone.push_back(bone.rest);
    pose.morph_weights = character.rest_morph_weights;
    return pose;
  });
}

Status sample_clip(const Clip& clip, double time, Pose& pose) {
  if (!std::isfinite(time))
    return Status::failure(StatusCode::non_finite_value, kNone,
                           "clip '%.80s': the time is not finite", clip.name.c_str());
  for (std::uint32_t i = 0; i < clip.channels.size(); ++i) {
    const Channel& channel = clip.channels[i];
    const bool morphs = channel.target == ChannelTarget::morph_weights;
    const std::uint64_t last = std::uint64_t{channel.index} + (morphs ? channel.width : 1);
    if (last > (morphs ? pose.morph_weights.size() : pose.parent_from_bone.size()))
      return Status::failure(
          StatusCode::size_mismatch, i,
          "clip '%.80s': channel %u drives a bone or morph weight that the pose does not have",
          clip.name.c_str(), i);
  }
  for (const Channel& channel : clip.channels) {
    if (channel.target == ChannelTarget::morph_weights)
      skinning::sample_channel(channel, time, pose.morph_weights);
    else
      skinning::sample_channel(channel, time, pose.parent_from_bone[channel.index]);
  }
  return {};
}

}  // namespace sunder
