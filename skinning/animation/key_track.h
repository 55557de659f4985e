#pragma once

#include <sunder/core/character.h>

#include <array>
#include <cstdint>
#include <vector>

namespace sunder::animation {

/// A channel of a clip that is edited.
struct KeyTrack {
  Channel channel;
  bool has_own_tangents = false;  ///< The editor made it, so all its tangents follow its keys.

  /// Number of floats per key.
  [[nodiscard]] std::size_t stride() const;
  /// Position of the first key at or after a time.
  [[nodiscard]] std::size_t lower_bound(float time) const;
  [[nodiscard]] bool has_key(float time) const;

  /// Makes room for keys, so that put() allocates nothing. @throws std::bad_alloc
  void make_room(std::size_t keys);
  /// Writes the part of a pose that the channel drives as a key, in place of one at the same time.
  void put(float time, const Pose& pose);
  void remove(std::size_t key);
  /// Moves a key to another time, over one that is there.
  void move(std::size_t key, float time);
  /// Makes quaternions of splines neighbours on the sphere, and tangents follow the keys.
  /// @param key  of a track with tangents of its own: all; else of this key only.
  void smooth(std::size_t key);

 private:
  void write_value(std::size_t key, const Pose& pose);
  void write_tangents(std::size_t key);
  [[nodiscard]] float* value(std::size_t key);
};

/// A new track for a part of a bone or for morph weights, without keys.
[[nodiscard]] KeyTrack make_track(ChannelTarget target, std::uint32_t index, std::uint32_t width,
                                  Interpolation interpolation);

/// Whether two poses give a channel the same value; a quaternion and its negative are the same.
[[nodiscard]] bool is_same_value(const Channel& channel, const Pose& a, const Pose& b);

}  // namespace sunder::animation
