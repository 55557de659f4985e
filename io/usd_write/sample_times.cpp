#include "io/usd_write/sample_times.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "skinning/internal/sample_channel.h"

namespace sunder::usd {
namespace {

/// Times are floats, so a key at a whole frame is at it within some of their digits.
bool is_at(double code, double whole) {
  return std::abs(code - whole) <= 2.5e-7 * std::abs(code) + 1e-6;
}

bool has_whole_keys(const Channel& channel, double rate) {
  return std::all_of(channel.times.begin(), channel.times.end(), [&](float time) {
    const double code = static_cast<double>(time) * rate;
    return is_at(code, std::nearbyint(code));
  });
}

std::vector<float> values_at(const Channel& channel, double seconds) {
  if (channel.target == ChannelTarget::morph_weights) {
    std::vector<float> weights(std::size_t{channel.index} + channel.width);
    skinning::sample_channel(channel, seconds, weights);
    weights.erase(weights.begin(), weights.begin() + channel.index);
    return weights;
  }
  BoneTransform bone;
  skinning::sample_channel(channel, seconds, bone);
  if (channel.target == ChannelTarget::rotation)
    return {bone.rotation.x(), bone.rotation.y(), bone.rotation.z(), bone.rotation.w()};
  const Vec3f& vector = channel.target == ChannelTarget::scale ? bone.scale : bone.translation;
  return {vector.x(), vector.y(), vector.z()};
}

/// Adds times within the segments of a cubic spline.
class SplineTimes {
 public:
  SplineTimes(const Channel& channel, std::vector<double>& times)
      : channel_(channel), times_(times), tolerance_(tolerance()) {
    for (std::size_t key = 0; key + 1 < channel.times.size(); ++key)
      divide(static_cast<double>(channel.times[key]), static_cast<double>(channel.times[key + 1]),
             0);
  }

 private:
  static constexpr int kMostHalvings = 6;

  [[nodiscard]] float tolerance() const {
    if (channel_.target == ChannelTarget::rotation) return 5e-5f;  // half an angle
    float range = 0;
    const std::vector<float> first = values_at(channel_, 0);
    for (const float time : channel_.times) {
      const std::vector<float> values = values_at(channel_, static_cast<double>(time));
      for (std::size_t i = 0; i < values.size(); ++i)
        range = std::max(range, std::abs(values[i] - first[i]));
    }
    return 1e-4f * range;
  }

  [[nodiscard]] bool is_straight(double from, double to) const {
    const std::vector<float> first = values_at(channel_, from), last = values_at(channel_, to);
    for (const float share : {0.25f, 0.5f, 0.75f}) {
      const std::vector<float> inside =
          values_at(channel_, from + static_cast<double>(share) * (to - from));
      for (std::size_t i = 0; i < inside.size(); ++i)
        if (std::abs(first[i] + share * (last[i] - first[i]) - inside[i]) > tolerance_)
          return false;
    }
    return true;
  }

  void divide(double from, double to, int halvings) {
    if (halvings == kMostHalvings || is_straight(from, to)) return;
    const double middle = 0.5 * (from + to);
    times_.push_back(middle);
    divide(from, middle, halvings + 1);
    divide(middle, to, halvings + 1);
  }

  const Channel& channel_;
  std::vector<double>& times_;
  float tolerance_ = 0;
};

/// A moment before each key but the first, at which the value of the key before still holds.
void add_times_before_steps(const Channel& channel, std::vector<double>& times) {
  for (std::size_t key = 1; key < channel.times.size(); ++key) {
    const double before = static_cast<double>(channel.times[key - 1]),
                 at = static_cast<double>(channel.times[key]);
    times.push_back(at - std::min(1e-4, 0.5 * (at - before)));
  }
}

}  // namespace

double time_code(double seconds, double codes_per_second) {
  const double code = seconds * codes_per_second, whole = std::nearbyint(code);
  return is_at(code, whole) ? whole : code;
}

double time_codes_per_second(const std::vector<Clip>& clips) {
  for (const double rate : {24.0, 25.0, 30.0, 50.0, 60.0, 120.0}) {
    const bool is_whole = std::all_of(clips.begin(), clips.end(), [&](const Clip& clip) {
      return std::all_of(clip.channels.begin(), clip.channels.end(),
                         [&](const Channel& channel) { return has_whole_keys(channel, rate); });
    });
    if (is_whole) return rate;
  }
  return 60;
}

std::vector<SampleTime> sample_times(std::span<const Channel* const> channels,
                                     double codes_per_second) {
  std::vector<double> seconds;
  for (const Channel* channel : channels) {
    for (const float time : channel->times) seconds.push_back(static_cast<double>(time));
    if (channel->interpolation == Interpolation::step) add_times_before_steps(*channel, seconds);
    if (channel->interpolation == Interpolation::cubic_spline) SplineTimes(*channel, seconds);
  }
  if (seconds.empty()) return {{}};
  std::sort(seconds.begin(), seconds.end());
  std::vector<SampleTime> times;
  for (const double time : seconds) {
    const double code = time_code(time, codes_per_second);
    if (times.empty() || code > times.back().code) times.push_back({code, time});
  }
  return times;
}

}  // namespace sunder::usd
