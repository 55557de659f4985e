#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sunder {

enum class Interpolation : std::uint8_t { linear, step, cubic_spline };

/// What a channel drives: one part of one bone's transform, or a run of morph weights.
enum class ChannelTarget : std::uint8_t { translation, rotation, scale, morph_weights };

/// Key frames of one animated value, as in glTF 2.0.
struct Channel {
  ChannelTarget target = ChannelTarget::translation;
  /// The bone; for morph weights, the first weight in Pose::morph_weights.
  std::uint32_t index = 0;
  /// Floats of one value: 3 (translation, scale), 4 (rotation, x y z w) or the number of morph
  /// weights driven.
  std::uint32_t width = 3;
  Interpolation interpolation = Interpolation::linear;
  std::vector<float> times;  ///< Seconds, strictly increasing, >= 0, at least one.
  /// times.size() * width floats; three times as many for cubic_spline (in-tangent, value,
  /// out-tangent a key).
  std::vector<float> values;

  bool operator==(const Channel&) const = default;
};

struct Clip {
  std::string name;
  float duration = 0.0f;  ///< Seconds: the last key of all channels.
  std::vector<Channel> channels;

  bool operator==(const Clip&) const = default;
};

}  // namespace sunder
