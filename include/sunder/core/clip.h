#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sunder {

enum class Interpolation : std::uint8_t { linear, step, cubic_spline };

/// The value that a channel drives: one part of one bone's transform, or consecutive morph weights.
enum class ChannelTarget : std::uint8_t { translation, rotation, scale, morph_weights };

/// Keyframes of one animated value, as in glTF 2.0.
struct Channel {
  ChannelTarget target = ChannelTarget::translation;
  /// Index of the bone; for morph weights, index of the first one in Pose::morph_weights.
  std::uint32_t index = 0;
  /// Floats per value: 3 (translation, scale), 4 (rotation, x y z w) or the number of driven morph
  /// weights.
  std::uint32_t width = 3;
  Interpolation interpolation = Interpolation::linear;
  std::vector<float> times;  ///< Seconds, strictly increasing, >= 0, at least one.
  /// times.size() * width floats; three times as many for cubic_spline (in-tangent, value and
  /// out-tangent per key).
  std::vector<float> values;

  bool operator==(const Channel&) const = default;
};

struct Clip {
  std::string name;
  float duration = 0.0f;  ///< Seconds; time of the last key of any channel.
  std::vector<Channel> channels;

  bool operator==(const Clip&) const = default;
};

}  // namespace sunder
