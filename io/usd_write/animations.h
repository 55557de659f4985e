#pragma once

#include <sunder/core/character.h>

#include <string>
#include <vector>

#include "io/usd_write/joints.h"
#include "io/usd_write/usd_text.h"

namespace sunder::usd {

/// Writes a SkelAnimation prim: the joints that a clip moves, at its keys, and all morph weights.
/// Joints that it does not name stand at rest.
class AnimationWriter {
 public:
  /// @param shapes  names of the morph weights, as blend_shape_names().
  AnimationWriter(const Character& character, const Joints& joints,
                  const std::vector<std::string>& shapes, double codes_per_second)
      : character_(character), joints_(joints), shapes_(shapes), rate_(codes_per_second) {}

  /// @param metadata  of the prim.
  void write(UsdText& text, const std::string& name, const std::vector<std::string>& metadata,
             const Clip& clip) const;

 private:
  /// Of several channels with the same target the last one counts, as in a pose.
  struct MovedBone {
    std::uint32_t bone = 0;
    const Channel* translation = nullptr;
    const Channel* rotation = nullptr;
    const Channel* scale = nullptr;
  };
  using ChannelOf = const Channel* MovedBone::*;

  [[nodiscard]] std::vector<MovedBone> moved_bones(const Clip& clip) const;
  void write_transforms(UsdText& text, const std::vector<MovedBone>& moved) const;
  /// @param value  adds the numbers of a bone, relative to its parent, as USD orders them.
  template <class Value>
  void write_samples(UsdText& text, const char* head, const std::vector<MovedBone>& moved,
                     ChannelOf channel_of, const Value& value) const;
  void write_weights(UsdText& text, const Clip& clip) const;

  const Character& character_;
  const Joints& joints_;
  const std::vector<std::string>& shapes_;
  double rate_;
};

}  // namespace sunder::usd
