#include "tools/open/weights_channel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace sunder::tools {
namespace {

/// An opening takes at least this long, where the clip has room.
constexpr double kShortest = 1.0 / 60;

/// A value at a time, and its change per second before and after it.
struct Sample {
  double value = 0, slope_before = 0, slope_after = 0;
};

double hermite(double p, double m, double q, double n, double t) {
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * p + (t3 - 2 * t2 + t) * m + (3 * t2 - 2 * t3) * q + (t3 - t2) * n;
}

double hermite_slope(double p, double m, double q, double n, double t) {
  const double t2 = t * t;
  return (6 * t2 - 6 * t) * (p - q) + (3 * t2 - 4 * t + 1) * m + (3 * t2 - 2 * t) * n;
}

/// One weight of a channel at a time.
Sample sample(const Channel& channel, std::uint32_t weight, double time) {
  const auto& times = channel.times;
  const bool is_spline = channel.interpolation == Interpolation::cubic_spline;
  const auto at = [&](std::size_t key, std::size_t part) {
    const std::size_t row = is_spline ? 3 * key + part : key;
    return static_cast<double>(channel.values[row * channel.width + weight]);
  };
  const auto after = std::upper_bound(times.begin(), times.end(), static_cast<float>(time));
  const auto next = static_cast<std::size_t>(after - times.begin());
  if (next == 0) return {at(0, 1), is_spline ? at(0, 0) : 0, is_spline ? at(0, 2) : 0};
  const std::size_t key = next - 1;
  const double begin = times[key];
  const bool is_key = static_cast<double>(static_cast<float>(time)) == begin;
  if (is_key || next == times.size() || channel.interpolation == Interpolation::step)
    return is_spline && is_key ? Sample{at(key, 1), at(key, 0), at(key, 2)} : Sample{at(key, 1)};
  const double length = static_cast<double>(times[next]) - begin, t = (time - begin) / length;
  if (!is_spline) return {(1 - t) * at(key, 1) + t * at(next, 1)};
  const double p = at(key, 1), m = length * at(key, 2), q = at(next, 1), n = length * at(next, 0);
  const double slope = hermite_slope(p, m, q, n, t) / length;
  return {hermite(p, m, q, n, t), slope, slope};
}

Sample sample(std::span<const WeightKey> keys, double time) {
  const auto slope = [&](std::size_t from) {
    if (from + 1 >= keys.size()) return 0.0;
    return (keys[from + 1].weight - keys[from].weight) / (keys[from + 1].time - keys[from].time);
  };
  std::size_t next = 0;
  while (next < keys.size() && keys[next].time <= time) ++next;
  if (next == 0) return {keys.front().weight};
  const std::size_t key = next - 1;
  if (keys[key].time == time)
    return {keys[key].weight, key == 0 ? 0.0 : slope(key - 1), slope(key)};
  const double value = keys[key].weight + slope(key) * (time - keys[key].time);
  return {value, slope(key), slope(key)};
}

/// The keys with times that floats tell apart.
std::vector<WeightKey> as_floats(std::span<const WeightKey> keys) {
  std::vector<WeightKey> distinct;
  for (WeightKey key : keys) {
    key.time = static_cast<double>(static_cast<float>(key.time));
    if (!distinct.empty() && distinct.back().time == key.time) distinct.pop_back();
    distinct.push_back(key);
  }
  return distinct;
}

std::vector<float> union_of(const std::vector<float>& times, std::span<const WeightKey> keys) {
  std::vector<float> of_keys, all;
  for (const WeightKey& key : keys) of_keys.push_back(static_cast<float>(key.time));
  std::set_union(times.begin(), times.end(), of_keys.begin(), of_keys.end(),
                 std::back_inserter(all));
  return all;
}

}  // namespace

std::vector<WeightKey> keys_of(const Opening& opening, double moment, double duration,
                               std::optional<double> end) {
  const double length = opening.course.back().seconds;
  if (!(duration > 0) || !(length > 0)) return {{0, 1}};
  double begin = std::clamp(moment, 0.0, duration);
  if (begin + kShortest > duration) begin = std::max(0.0, duration - kShortest);
  if (end) return {{begin, 0}, {std::clamp(*end, begin + kShortest, duration), 1}};
  const double faster = std::min(1.0, (duration - begin) / length);
  std::vector<WeightKey> keys;
  for (const Opening::Moment& at : opening.course)
    keys.push_back({std::min(begin + faster * at.seconds, duration), at.share});
  return keys;
}

Channel with_weight(const Channel* old, std::span<const float> rest, std::uint32_t old_first,
                    std::span<const WeightKey> keys, std::uint32_t first) {
  const std::vector<WeightKey> distinct = as_floats(keys);
  Channel channel;
  channel.target = ChannelTarget::morph_weights;
  channel.index = first;
  channel.width = static_cast<std::uint32_t>(rest.size() + 1);
  channel.interpolation = old == nullptr ? Interpolation::linear : old->interpolation;
  const bool is_constant = distinct.size() == 1;
  if (old == nullptr || !is_constant)
    channel.times = union_of(old == nullptr ? std::vector<float>() : old->times, distinct);
  else
    channel.times = old->times;
  const bool is_spline = channel.interpolation == Interpolation::cubic_spline;
  for (const float time : channel.times) {
    std::array<std::vector<float>, 3> rows;  // Slope before, value, slope after.
    const auto add = [&](const Sample& sample) {
      rows[0].push_back(static_cast<float>(sample.slope_before));
      rows[1].push_back(static_cast<float>(sample.value));
      rows[2].push_back(static_cast<float>(sample.slope_after));
    };
    for (std::uint32_t i = 0; i < rest.size(); ++i) {
      const std::uint32_t weight = old_first + i;
      const bool is_driven =
          old != nullptr && weight >= old->index && weight < old->index + old->width;
      const auto seconds = static_cast<double>(time);
      add(is_driven ? sample(*old, weight - old->index, seconds)
                    : Sample{static_cast<double>(rest[i])});
    }
    add(sample(distinct, static_cast<double>(time)));
    for (std::size_t row = is_spline ? 0 : 1; row < (is_spline ? 3u : 2u); ++row)
      channel.values.insert(channel.values.end(), rows[row].begin(), rows[row].end());
  }
  return channel;
}

}  // namespace sunder::tools
