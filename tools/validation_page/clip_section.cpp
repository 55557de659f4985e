#include "tools/validation_page/clip_section.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/validation_page/page_data.h"

namespace sunder::tools {
namespace {

/// Translation, rotation, scale of a bone, back to back.
using Parts = std::array<float, 10>;

struct Part {
  const char* name;
  std::size_t first, width;
};
constexpr std::array<Part, 3> kParts = {
    {{"translation", 0, 3}, {"rotation", 3, 4}, {"scale", 7, 3}}};

Parts parts_of(const BoneTransform& transform) {
  Parts parts{};
  for (int i = 0; i < 3; ++i) parts[static_cast<std::size_t>(i)] = transform.translation[i];
  for (int i = 0; i < 4; ++i)
    parts[static_cast<std::size_t>(3 + i)] = transform.rotation.coeffs()[i];
  for (int i = 0; i < 3; ++i) parts[static_cast<std::size_t>(7 + i)] = transform.scale[i];
  return parts;
}

std::size_t sample_count(const Clip& clip) {
  const double wanted = std::ceil(clip.duration * kPageSamplesPerSecond);
  return 1 + static_cast<std::size_t>(std::min(wanted, static_cast<double>(kPageMostSamples)));
}

/// The parts of every bone at every sample, sample by sample.
Result<std::vector<Parts>> sample_parts(const Character& character, const Clip& clip) {
  const std::size_t samples = sample_count(clip);
  std::vector<Parts> all;
  Result<Pose> pose = local_rest_pose(character);
  if (!pose) return pose.error();
  for (std::size_t sample = 0; sample < samples; ++sample) {
    const double time = samples == 1 ? 0.0
                                     : clip.duration * static_cast<double>(sample) /
                                           static_cast<double>(samples - 1);
    if (Status status = sample_clip(clip, time, *pose); !status) return status;
    for (const BoneTransform& transform : pose->parent_from_bone)
      all.push_back(parts_of(transform));
  }
  return all;
}

Json tracks_of(const Character& character, const std::vector<Parts>& all, DataArrays& arrays) {
  const std::size_t bones = character.skeleton.bones.size();
  Json tracks = Json::array();
  for (std::size_t bone = 0; bone < bones; ++bone) {
    const Parts rest = parts_of(character.skeleton.bones[bone].rest);
    for (const Part& part : kParts) {
      std::vector<float> values;
      for (std::size_t i = bone; i < all.size(); i += bones)
        values.insert(values.end(), &all[i][part.first], &all[i][part.first] + part.width);
      bool leaves_rest = false;
      for (std::size_t i = 0; i < values.size(); ++i)
        leaves_rest = leaves_rest || values[i] != rest[part.first + i % part.width];
      if (leaves_rest)
        tracks.push_back({{"bone", bone}, {"part", part.name}, {"values", arrays.add(values)}});
    }
  }
  return tracks;
}

}  // namespace

Json skeleton_section(const Skeleton& skeleton, DataArrays& arrays) {
  std::vector<float> rest;
  std::vector<std::uint32_t> parents;
  for (const Bone& bone : skeleton.bones) {
    const Parts parts = parts_of(bone.rest);
    rest.insert(rest.end(), parts.begin(), parts.end());
    parents.push_back(bone.parent);
  }
  return {{"parents", arrays.add(parents)}, {"rest", arrays.add(rest)}};
}

Result<Json> clips_section(const Character& character, DataArrays& arrays) {
  Json clips = Json::array();
  for (const Clip& clip : character.clips) {
    const auto all = sample_parts(character, clip);
    if (!all) return all.error();
    clips.push_back({{"name", clip.name},
                     {"duration", clip.duration},
                     {"samples", sample_count(clip)},
                     {"tracks", tracks_of(character, *all, arrays)}});
  }
  return clips;
}

}  // namespace sunder::tools
