#pragma once

#include <sunder/core/character.h>

#include <string>
#include <vector>

#include "io/usd_write/joints.h"
#include "io/usd_write/sample_times.h"
#include "io/usd_write/usd_text.h"

namespace sunder::usd {

/// Writes SkelAnimation prims: the joints that a clip moves, at its keys, and all morph weights.
/// Joints that it does not name stand at rest.
class AnimationWriter {
 public:
  /// @param shapes  names of the morph weights, as blend_shape_names().
  /// @throws gltf::Refusal  if the clips have more samples in all than SampleCount holds.
  AnimationWriter(const Character& character, const Joints& joints,
                  const std::vector<std::string>& shapes, double codes_per_second,
                  const std::vector<Clip>& clips);

  /// @param clip  its number.
  /// @param metadata  of the prim.
  void write(UsdText& text, const std::string& name, const std::vector<std::string>& metadata,
             std::size_t clip) const;

 private:
  /// Of several channels with the same target the last one counts, as in a pose.
  struct MovedBone {
    std::uint32_t bone = 0;
    const Channel* translation = nullptr;
    const Channel* rotation = nullptr;
    const Channel* scale = nullptr;
  };
  using ChannelOf = const Channel* MovedBone::*;
  /// What a clip changes, and when.
  struct Animation {
    std::vector<MovedBone> moved;
    std::vector<const Channel*> weights;
    std::vector<SampleTime> translation_times, rotation_times, scale_times, weight_times;
  };

  [[nodiscard]] static std::vector<MovedBone> moved_bones(const Clip& clip);
  [[nodiscard]] Animation animation_of(const Clip& clip, double codes_per_second,
                                       SampleCount& samples) const;
  void write_transforms(UsdText& text, const Animation& animation) const;
  /// @param value  adds the numbers of a bone, relative to its parent, as USD orders them.
  template <class Value>
  void write_samples(UsdText& text, const char* head, const std::vector<SampleTime>& times,
                     const std::vector<MovedBone>& moved, ChannelOf channel_of,
                     const Value& value) const;
  void write_weights(UsdText& text, const Animation& animation) const;

  const Character& character_;
  const Joints& joints_;
  const std::vector<std::string>& shapes_;
  std::vector<std::string> written_shapes_;
  std::vector<Animation> animations_;  ///< One per clip.
};

}  // namespace sunder::usd
