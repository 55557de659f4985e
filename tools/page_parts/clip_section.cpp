#include "tools/page_parts/clip_section.h"

#include <map>

namespace sunder::tools {
namespace {

const char* part_name(ChannelTarget target) {
  switch (target) {
    case ChannelTarget::translation: return "translation";
    case ChannelTarget::rotation: return "rotation";
    case ChannelTarget::scale: return "scale";
    case ChannelTarget::morph_weights: return "morph_weights";
  }
  return "";
}

const char* interpolation_name(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::linear: return "linear";
    case Interpolation::step: return "step";
    case Interpolation::cubic_spline: return "cubic_spline";
  }
  return "";
}

/// The times of keys, each list once: the channels of a clip usually share them.
class KeyTimes {
 public:
  explicit KeyTimes(DataArrays& arrays) : arrays_(arrays) {}

  const Json& add(const std::vector<float>& times) {
    const auto [entry, is_new] = added_.try_emplace(times);
    if (is_new) entry->second = arrays_.add(times);
    return entry->second;
  }

 private:
  DataArrays& arrays_;
  std::map<std::vector<float>, Json> added_;
};

}  // namespace

Json skeleton_section(const Character& character, DataArrays& arrays) {
  std::vector<float> rest;
  std::vector<std::uint32_t> parents;
  for (const Bone& bone : character.skeleton.bones) {
    const BoneTransform& local = bone.rest;
    rest.insert(rest.end(), local.translation.data(), local.translation.data() + 3);
    rest.insert(rest.end(), local.rotation.coeffs().data(), local.rotation.coeffs().data() + 4);
    rest.insert(rest.end(), local.scale.data(), local.scale.data() + 3);
    parents.push_back(bone.parent);
  }
  return {{"parents", arrays.add(parents)},
          {"rest", arrays.add(rest)},
          {"morph_weights", arrays.add(character.rest_morph_weights)}};
}

Json clips_section(const Character& character, DataArrays& arrays) {
  Json clips = Json::array();
  KeyTimes key_times(arrays);
  for (const Clip& clip : character.clips) {
    Json tracks = Json::array();
    for (const Channel& channel : clip.channels)
      tracks.push_back({{"part", part_name(channel.target)},
                        {"index", channel.index},
                        {"width", channel.width},
                        {"interpolation", interpolation_name(channel.interpolation)},
                        {"times", key_times.add(channel.times)},
                        {"values", arrays.add(channel.values)}});
    clips.push_back(
        {{"name", clip.name}, {"duration", clip.duration}, {"tracks", std::move(tracks)}});
  }
  return clips;
}

}  // namespace sunder::tools
