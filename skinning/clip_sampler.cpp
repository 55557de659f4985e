#include "skinning/clip_sampler.h"

#include <algorithm>

#include "skinning/internal/bone_tree.h"
#include "skinning/internal/sample_channel.h"

namespace sunder::skinning {

ClipSampler::ClipSampler(const Clip& clip) {
  for (std::uint32_t i = 0; i < clip.channels.size(); ++i)
    (clip.channels[i].target == ChannelTarget::morph_weights ? morph_channels_ : bone_channels_)
        .push_back(i);
  std::stable_sort(bone_channels_.begin(), bone_channels_.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return clip.channels[a].index < clip.channels[b].index;
                   });
}

void ClipSampler::sample(const Character& character, const Clip& clip, double time,
                         ModelPose& pose) const {
  const auto& bones = character.skeleton.bones;
  pose.model_from_bone.resize(bones.size());
  auto next = bone_channels_.begin();
  const auto sampled = [&](std::size_t bone) {
    BoneTransform local = bones[bone].rest;
    for (; next != bone_channels_.end() && clip.channels[*next].index == bone; ++next)
      sample_channel(clip.channels[*next], time, local);
    return local;
  };
  multiply_down(character.skeleton, sampled, pose.model_from_bone);
  pose.morph_weights = character.rest_morph_weights;
  for (const std::uint32_t channel : morph_channels_)
    sample_channel(clip.channels[channel], time, pose.morph_weights);
}

}  // namespace sunder::skinning
