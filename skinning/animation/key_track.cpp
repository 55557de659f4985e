#include "skinning/animation/key_track.h"

#include <algorithm>
#include <span>

#include "core/internal/ordered.h"

namespace sunder::animation {
namespace {

bool is_spline(const Channel& channel) {
  return channel.interpolation == Interpolation::cubic_spline;
}

/// The part of a pose that a channel drives.
std::span<const float> value_of(const Channel& channel, const Pose& pose) {
  if (channel.target == ChannelTarget::morph_weights)
    return {pose.morph_weights.data() + channel.index, channel.width};
  const BoneTransform& bone = pose.parent_from_bone[channel.index];
  switch (channel.target) {
    case ChannelTarget::translation: return {bone.translation.data(), 3};
    case ChannelTarget::scale: return {bone.scale.data(), 3};
    default: return {bone.rotation.coeffs().data(), 4};
  }
}

float product(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

}  // namespace

KeyTrack make_track(ChannelTarget target, std::uint32_t index, std::uint32_t width,
                    Interpolation interpolation) {
  KeyTrack track;
  track.channel.target = target;
  track.channel.index = index;
  track.channel.width = width;
  track.channel.interpolation = interpolation;
  track.has_own_tangents = true;
  return track;
}

bool is_same_value(const Channel& channel, const Pose& a, const Pose& b) {
  const auto left = value_of(channel, a), right = value_of(channel, b);
  if (std::equal(left.begin(), left.end(), right.begin())) return true;
  return channel.target == ChannelTarget::rotation &&
         std::equal(left.begin(), left.end(), right.begin(),
                    [](float one, float other) { return one == -other; });
}

std::size_t KeyTrack::stride() const { return channel.width * (is_spline(channel) ? 3u : 1u); }

std::size_t KeyTrack::lower_bound(float time) const {
  return static_cast<std::size_t>(
      std::lower_bound(channel.times.begin(), channel.times.end(), time) - channel.times.begin());
}

bool KeyTrack::has_key(float time) const {
  const std::size_t key = lower_bound(time);
  return key < channel.times.size() && channel.times[key] == time;
}

void KeyTrack::make_room(std::size_t keys) {
  const std::size_t wanted = channel.times.size() + keys;
  if (wanted <= channel.times.capacity() && wanted * stride() <= channel.values.capacity()) return;
  channel.times.reserve(2 * wanted);
  channel.values.reserve(2 * wanted * stride());
}

float* KeyTrack::value(std::size_t key) {
  return channel.values.data() + key * stride() + (is_spline(channel) ? channel.width : 0);
}

void KeyTrack::put(float time, const Pose& pose) {
  const std::size_t key = lower_bound(time);
  const bool is_new = key == channel.times.size() || channel.times[key] != time;
  if (is_new) {
    const auto at = static_cast<std::ptrdiff_t>(key);
    channel.times.insert(channel.times.begin() + at, time);
    channel.values.insert(channel.values.begin() + at * static_cast<std::ptrdiff_t>(stride()),
                          stride(), 0.0f);
  }
  write_value(key, pose);
  if (is_new || has_own_tangents) smooth(key);
}

void KeyTrack::write_value(std::size_t key, const Pose& pose) {
  const auto wanted = value_of(channel, pose);
  float* const to = value(key);
  std::copy(wanted.begin(), wanted.end(), to);
  if (!is_spline(channel) || channel.target != ChannelTarget::rotation || key == 0) return;
  // A spline interpolates the four numbers: neighbours need the same hemisphere.
  if (product(value(key - 1), to) < 0.0f)
    for (int i = 0; i < 4; ++i) to[i] = -to[i];
}

void KeyTrack::smooth(std::size_t key) {
  if (!is_spline(channel)) return;
  if (!has_own_tangents) {
    write_tangents(key);
    return;
  }
  for (std::size_t i = 1; channel.target == ChannelTarget::rotation && i < channel.times.size();
       ++i)
    if (product(value(i - 1), value(i)) < 0.0f)
      for (int k = 0; k < 4; ++k) value(i)[k] = -value(i)[k];
  for (std::size_t i = 0; i < channel.times.size(); ++i) write_tangents(i);
}

void KeyTrack::write_tangents(std::size_t key) {
  const std::uint32_t width = channel.width;
  float* const at = value(key);
  const bool is_inside = key > 0 && key + 1 < channel.times.size();
  const float seconds = is_inside ? channel.times[key + 1] - channel.times[key - 1] : 0.0f;
  for (std::uint32_t i = 0; i < width; ++i) {
    const float tangent = is_inside ? (value(key + 1)[i] - value(key - 1)[i]) / seconds : 0.0f;
    at[static_cast<std::ptrdiff_t>(i) - static_cast<std::ptrdiff_t>(width)] = tangent;
    at[width + i] = tangent;
  }
}

void KeyTrack::remove(std::size_t key) {
  const auto at = static_cast<std::ptrdiff_t>(key), floats = static_cast<std::ptrdiff_t>(stride());
  channel.times.erase(channel.times.begin() + at);
  channel.values.erase(channel.values.begin() + at * floats,
                       channel.values.begin() + (at + 1) * floats);
  if (has_own_tangents && !channel.times.empty()) smooth(0);
}

void KeyTrack::move(std::size_t key, float time) {
  const auto first = channel.values.begin() + static_cast<std::ptrdiff_t>(key * stride());
  const std::vector<float> values(first, first + static_cast<std::ptrdiff_t>(stride()));
  remove(key);
  const std::size_t to = lower_bound(time);
  if (to < channel.times.size() && channel.times[to] == time) {
    std::copy(values.begin(), values.end(),
              channel.values.begin() + static_cast<std::ptrdiff_t>(to * stride()));
  } else {
    channel.times.insert(channel.times.begin() + static_cast<std::ptrdiff_t>(to), time);
    channel.values.insert(channel.values.begin() + static_cast<std::ptrdiff_t>(to * stride()),
                          values.begin(), values.end());
  }
  if (has_own_tangents) smooth(to);
}

}  // namespace sunder::animation
