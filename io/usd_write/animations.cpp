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

std::vector<AnimationWriter::MovedBone> AnimationWriter::moved_bones(const Clip& clip) const {
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

template <class Value>
void AnimationWriter::write_samples(UsdText& text, const char* head,
                                    const std::vector<MovedBone>& moved, ChannelOf channel_of,
                                    const Value& value) const {
  std::vector<const Channel*> channels;
  for (const MovedBone& bone : moved)
    if (bone.*channel_of != nullptr) channels.push_back(bone.*channel_of);
  std::vector<std::uint32_t> cursors(moved.size(), 0);
  std::vector<float> numbers;
  write_time_samples(text, head, sample_times(channels, rate_), [&](double seconds) {
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

void AnimationWriter::write_transforms(UsdText& text, const std::vector<MovedBone>& moved) const {
  std::vector<std::string> paths;
  for (const MovedBone& bone : moved) paths.push_back(joints_.all()[joints_.moved(bone.bone)].path);
  text.line("uniform token[] joints = " + array_of(std::span<const std::string>(paths)));
  write_samples(text, "float3[] translations", moved, &MovedBone::translation,
                [](std::uint32_t, const BoneTransform& bone, std::vector<float>& numbers) {
                  append(numbers, bone.translation);
                });
  write_samples(text, "quatf[] rotations", moved, &MovedBone::rotation,
                [](std::uint32_t, const BoneTransform& bone, std::vector<float>& numbers) {
                  numbers.push_back(bone.rotation.w());
                  append(numbers, bone.rotation.vec());
                });
  write_samples(text, "half3[] scales", moved, &MovedBone::scale,
                [&](std::uint32_t index, const BoneTransform& bone, std::vector<float>& numbers) {
                  const Vec3f scale = bone.scale.cwiseQuotient(joints_.scale_below(index));
                  for (int i = 0; i < 3; ++i) numbers.push_back(nearest_half(scale[i]));
                });
}

void AnimationWriter::write_weights(UsdText& text, const Clip& clip) const {
  std::vector<std::string> names;
  for (const std::string& shape : shapes_)
    if (!shape.empty()) names.push_back(shape);
  if (names.empty()) return;
  text.line("uniform token[] blendShapes = " + array_of(std::span<const std::string>(names)));
  std::vector<const Channel*> channels;
  for (const Channel& channel : clip.channels)
    if (channel.target == ChannelTarget::morph_weights) channels.push_back(&channel);
  std::vector<float> weights, written;
  write_time_samples(text, "float[] blendShapeWeights", sample_times(channels, rate_),
                     [&](double seconds) {
                       weights = character_.rest_morph_weights;
                       for (const Channel* const channel : channels)
                         skinning::sample_channel(*channel, seconds, weights);
                       written.clear();
                       for (std::size_t i = 0; i < weights.size(); ++i)
                         if (!shapes_[i].empty()) written.push_back(weights[i]);
                       return array_of(written, 1);
                     });
}

void AnimationWriter::write(UsdText& text, const std::string& name,
                            const std::vector<std::string>& metadata, const Clip& clip) const {
  text.open_prim("SkelAnimation", name, metadata);
  const std::vector<MovedBone> moved = moved_bones(clip);
  if (moved.empty())
    text.line("uniform token[] joints = []");
  else
    write_transforms(text, moved);
  write_weights(text, clip);
  text.close('}');
}

}  // namespace sunder::usd
