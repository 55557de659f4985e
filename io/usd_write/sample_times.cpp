#include "io/usd_write/sample_times.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "io/gltf/refusal.h"
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

/// How far samples may be off: 1e-4 of the range of a channel's values, 1e-4 rad of a rotation.
float tolerance_of(const Channel& channel) {
  if (channel.target == ChannelTarget::rotation) return 5e-5f;  // half an angle
  float range = 0;
  const std::vector<float> first = values_at(channel, 0);
  for (const float time : channel.times) {
    const std::vector<float> values = values_at(channel, static_cast<double>(time));
    for (std::size_t i = 0; i < values.size(); ++i)
      range = std::max(range, std::abs(values[i] - first[i]));
  }
  return 1e-4f * range;
}

/// Adds times within the segments of a cubic spline.
class SplineTimes {
 public:
  SplineTimes(const Channel& channel, std::vector<double>& times)
      : channel_(channel), times_(times), tolerance_(tolerance_of(channel)) {
    for (std::size_t key = 0; key + 1 < channel.times.size(); ++key)
      divide(static_cast<double>(channel.times[key]), static_cast<double>(channel.times[key + 1]),
             0);
  }

 private:
  static constexpr int kMostHalvings = 6;

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

/// Leaves out times between which all channels are straight within their tolerance. O(n log n) for
/// n values.
class ThinnedTimes {
 public:
  ThinnedTimes(std::span<const Channel* const> channels, const std::vector<double>& times)
      : times_(times), rows_(times.size()) {
    for (const Channel* const channel : channels) add(*channel, times);
    is_kept_.assign(times.size(), false);
    is_kept_.front() = is_kept_.back() = true;
    divide(0, times.size() - 1);
  }

  [[nodiscard]] bool is_kept(std::size_t time) const { return is_kept_[time]; }

 private:
  void add(const Channel& channel, const std::vector<double>& times) {
    const float tolerance = tolerance_of(channel);
    std::vector<float> before;
    for (std::size_t i = 0; i < times.size(); ++i) {
      std::vector<float> values = values_at(channel, times[i]);
      // The same rotation as before has the sign of before.
      float agreement = 1;
      if (channel.target == ChannelTarget::rotation && i > 0)
        agreement = std::inner_product(values.begin(), values.end(), before.begin(), 0.0f);
      if (agreement < 0)
        for (float& value : values) value = -value;
      rows_[i].insert(rows_[i].end(), values.begin(), values.end());
      before = std::move(values);
    }
    tolerances_.insert(tolerances_.end(), before.size(), tolerance);
  }

  [[nodiscard]] bool is_straight(std::size_t from, std::size_t to) const {
    for (std::size_t i = from + 1; i < to; ++i) {
      const auto share =
          static_cast<float>((times_[i] - times_[from]) / (times_[to] - times_[from]));
      for (std::size_t c = 0; c < tolerances_.size(); ++c) {
        const float between = rows_[from][c] + share * (rows_[to][c] - rows_[from][c]);
        if (std::abs(between - rows_[i][c]) > tolerances_[c]) return false;
      }
    }
    return true;
  }

  void divide(std::size_t from, std::size_t to) {
    if (to - from < 2 || is_straight(from, to)) return;
    const std::size_t middle = from + (to - from) / 2;
    is_kept_[middle] = true;
    divide(from, middle);
    divide(middle, to);
  }

  const std::vector<double>& times_;
  std::vector<std::vector<float>> rows_;  ///< The values of all channels, per time.
  std::vector<float> tolerances_;         ///< One per value.
  std::vector<bool> is_kept_;
};

/// Bones with keys at times of their own would give each of them a sample at every key of all.
/// Thins out what would be much.
/// @throws gltf::Refusal  for more than memory should hold.
void thin_out(std::span<const Channel* const> channels, std::vector<double>& seconds) {
  constexpr std::size_t kFew = 100'000;
  std::size_t densest = 0, values = 0;
  for (const Channel* const channel : channels) {
    densest = std::max(densest, channel->times.size());
    values += channel->target == ChannelTarget::morph_weights ? channel->width : 1;
  }
  const std::size_t samples = seconds.size() * values;
  if (samples <= kFew) return;
  SampleCount().add(seconds.size(), values);
  if (seconds.size() <= 2 * densest) return;
  const ThinnedTimes thinned(channels, seconds);
  std::vector<double> kept;
  for (std::size_t i = 0; i < seconds.size(); ++i)
    if (thinned.is_kept(i)) kept.push_back(seconds[i]);
  seconds = std::move(kept);
}

}  // namespace

void SampleCount::add(std::size_t times, std::size_t values) {
  constexpr std::size_t kMost = std::size_t{1} << 24;
  if (values != 0 && times > (kMost - count_) / values)
    gltf::refuse(StatusCode::limit_exceeded, kNone,
                 "a clip has %zu values at %zu times each, and clips before it %zu samples; USD "
                 "would have more than %zu samples",
                 values, times, count_, kMost);
  count_ += times * values;
}

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
                                     double codes_per_second, std::size_t values,
                                     SampleCount& written) {
  std::vector<double> seconds;
  for (const Channel* channel : channels) {
    for (const float time : channel->times) seconds.push_back(static_cast<double>(time));
    if (channel->interpolation == Interpolation::step) add_times_before_steps(*channel, seconds);
    if (channel->interpolation == Interpolation::cubic_spline) SplineTimes(*channel, seconds);
  }
  if (seconds.empty()) seconds.push_back(0);
  std::sort(seconds.begin(), seconds.end());
  seconds.erase(std::unique(seconds.begin(), seconds.end()), seconds.end());
  thin_out(channels, seconds);
  std::vector<SampleTime> times;
  for (const double time : seconds) {
    const double code = time_code(time, codes_per_second);
    if (times.empty() || code > times.back().code) times.push_back({code, time});
  }
  written.add(times.size(), values);
  return times;
}

}  // namespace sunder::usd
