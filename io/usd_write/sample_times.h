#pragma once

#include <sunder/core/character.h>

#include <cstddef>
#include <span>
#include <vector>

namespace sunder::usd {

/// Time codes per second such that the keys of all clips are at whole ones: the first of 24, 25,
/// 30, 50, 60 and 120; 60 if there is none, 24 without clips.
[[nodiscard]] double time_codes_per_second(const std::vector<Clip>& clips);

/// The time code of a moment. A time that is a float beside a whole code is at it.
[[nodiscard]] double time_code(double seconds, double codes_per_second);

struct SampleTime {
  double code = 0;     ///< By time_code().
  double seconds = 0;  ///< Of the clip.
};

/// The samples of the animations of a file. A sample is one value at one time: a translation, a
/// rotation, a scale or a weight.
class SampleCount {
 public:
  /// @throws gltf::Refusal  above 2^24 samples in all; nothing is added then.
  void add(std::size_t times, std::size_t values);

 private:
  std::size_t count_ = 0;
};

/// Times such that linear interpolation between the samples of them all is the channels' own: the
/// keys; for steps also a moment of at most 1e-4 s before each; for cubic splines more, until what
/// lies between is off by at most 1e-4 of the values' range (rotations: 1e-4 rad), or 64 for a key.
/// Where bones have keys at times of their own, such that the channels would have more than 100,000
/// samples and twice as many times as one of them has keys, times are left out as long as nothing
/// is off by more than that.
/// @param values   that are written at each time, those that no channel drives among them.
/// @param written  gets the samples.
/// @return ascending; {0} without a channel.
/// @throws gltf::Refusal  where `written` refuses them, or for channels with more samples than
/// that.
[[nodiscard]] std::vector<SampleTime> sample_times(std::span<const Channel* const> channels,
                                                   double codes_per_second, std::size_t values,
                                                   SampleCount& written);

}  // namespace sunder::usd
