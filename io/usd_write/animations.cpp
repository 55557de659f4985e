#include "io/usd_write/animations.h"

#include <map>

#include "io/usd_write/half.h"
#include "io/usd_write/sample_times.h"
#include "skinning/internal/sample_channel.h"

namespace sunder::usd {
namespace {

/// "head.timeSamples = {", a line per time, "}".
/// @param values  the array at a time.
template <class Values>
void write_time_samples(UsdText& text, const std::string& head,
                        const std::vector<SampleTime>& times, const Values& values) {
  text.open(head + ".timeSamples =", '{');
  for (const SampleTime& time : times)
    text.line(fixed_number(time.code) + ": " + values(time.seconds) + ",");
  text.close('}');
}

void append(std::vector<float>& numbers, const Vec3f& vector) {
  numbers.insert(numbers.end(), vector.data(), vector.data() + 3);
}

}  // namespace

AnimationWriter::AnimationWriter(const Character& character, const Joints& joints,
                                 const std::vector<std::string>& shapes, double codes_per_second,
                                 const std::vector<Clip>& clips)
    : character_(character), joints_(joints), shapes_(shapes) {
  for (const std::string& shape : shapes)
    if (!shape.empty()) written_shapes_.push_back(shape);
  SampleCount samples;
  for (const Clip& clip : clips)
    animations_.push_back(animation_of(clip, codes_per_second, samples));
}

std::vector<AnimationWriter::MovedBone> AnimationWriter::moved_bones(const Clip& clip) {
  std::map<std::uint32_t, MovedBone> moved;
  for (const Channel& channel : clip.channels) {
    if (channel.target == ChannelTarget::morph_weights) continue;
    MovedBone& bone = moved[channel.index];
    bone.bone = channel.index;
    if (channel.target == ChannelTarget::translation) bone.translation = &channel;
    if (channel.target == ChannelTarget::rotation) bone.rotation = &channel;
    if (channel.target == ChannelTarget::scale) bone.scale = &channel;
  }
  std::vector<MovedBone> sorted;
  for (const auto& [bone, channels] : moved) sorted.push_back(channels);
  return sorted;
}

AnimationWriter::Animation AnimationWriter::animation_of(const Clip& clip, double codes_per_second,
                                                         SampleCount& samples) const {
  Animation animation;
  animation.moved = moved_bones(clip);
  const auto times_of = [&](ChannelOf channel_of) {
    std::vector<const Channel*> channels;
    for (const MovedBone& bone : animation.moved)
      if (bone.*channel_of != nullptr) channels.push_back(bone.*channel_of);
    return sample_times(channels, codes_per_second, animation.moved.size(), samples);
  };
  animation.translation_times = times_of(&MovedBone::translation);
  animation.rotation_times = times_of(&MovedBone::rotation);
  animation.scale_times = times_of(&MovedBone::scale);
  if (written_shapes_.empty()) return animation;
  for (const Channel& channel : clip.channels)
    if (channel.target == ChannelTarget::morph_weights) animation.weights.push_back(&channel);
  animation.weight_times =
      sample_times(animation.weights, codes_per_second, written_shapes_.size(), samples);
  return animation;
}

template <class Value>
void AnimationWriter::write_samples(UsdText& text, const char* head,
                                    const std::vector<SampleTime>& times,
                                    const std::vector<MovedBone>& moved, ChannelOf channel_of,
                                    const Value& value) const {
  std::vector<std::uint32_t> cursors(moved.size(), 0);
  std::vector<float> numbers;
  write_time_samples(text, head, times, [&](double seconds) {
    numbers.clear();
    for (std::size_t i = 0; i < moved.size(); ++i) {
      BoneTransform bone = character_.skeleton.bones[moved[i].bone].rest;
      if (const Channel* const channel = moved[i].*channel_of; channel != nullptr)
        skinning::sample_channel(*channel, seconds, cursors[i], bone);
      value(moved[i].bone, bone, numbers);
    }
    return array_of(numbers, moved.empty() ? 1 : numbers.size() / moved.size());
  });
}

void AnimationWriter::write_transforms(UsdText& text, const Animation& animation) const {
  const std::vector<MovedBone>& moved = animation.moved;
  std::vector<std::string> paths;
  for (const MovedBone& bone : moved) paths.push_back(joints_.all()[joints_.moved(bone.bone)].path);
  text.line("uniform token[] joints = " + array_of(std::span<const std::string>(paths)));
  write_samples(text, "float3[] translations", animation.translation_times, moved,
                &MovedBone::translation,
                [](std::uint32_t, const BoneTransform& bone, std::vector<float>& numbers) {
                  append(numbers, bone.translation);
                });
  write_samples(text, "quatf[] rotations", animation.rotation_times, moved, &MovedBone::rotation,
                [](std::uint32_t, const BoneTransform& bone, std::vector<float>& numbers) {
                  numbers.push_back(bone.rotation.w());
                  append(numbers, bone.rotation.vec());
                });
  write_samples(text, "half3[] scales", animation.scale_times, moved, &MovedBone::scale,
                [&](std::uint32_t index, const BoneTransform& bone, std::vector<float>& numbers) {
                  const Vec3f scale = bone.scale.cwiseQuotient(joints_.scale_below(index));
                  for (int i = 0; i < 3; ++i) numbers.push_back(nearest_half(scale[i]));
                });
}

void AnimationWriter::write_weights(UsdText& text, const Animation& animation) const {
  if (written_shapes_.empty()) return;
  text.line("uniform token[] blendShapes = " +
            array_of(std::span<const std::string>(written_shapes_)));
  std::vector<float> weights, written;
  write_time_samples(text, "float[] blendShapeWeights", animation.weight_times,
                     [&](double seconds) {
                       weights = character_.rest_morph_weights;
                       for (const Channel* const channel : animation.weights)
                         skinning::sample_channel(*channel, seconds, weights);
                       written.clear();
                       for (std::size_t i = 0; i < weights.size(); ++i)
                         if (!shapes_[i].empty()) written.push_back(weights[i]);
                       return array_of(written, 1);
                     });
}

void AnimationWriter::write(UsdText& text, const std::string& name,
                            const std::vector<std::string>& metadata, std::size_t clip) const {
  const Animation& animation = animations_[clip];
  text.open_prim("SkelAnimation", name, metadata);
  if (animation.moved.empty())
    text.line("uniform token[] joints = []");
  else
    write_transforms(text, animation);
  write_weights(text, animation);
  text.close('}');
}

}  // namespace sunder::usd
