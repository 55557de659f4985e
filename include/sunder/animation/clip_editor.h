#pragma once

#include <sunder/core/api.h>
#include <sunder/core/character.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sunder {

/// The tracks that get a key. A track is a channel of the clip: the translation, rotation or scale
/// of a bone, or the morph weights of a mesh.
enum class KeyedTracks : std::uint8_t {
  /// Those that the clip has, and new ones for what differs from the rest pose: poses of other keys
  /// may change later without changing this one.
  tracked,
  changed,  ///< Those whose value differs from what the clip gives at this time.
  all,      ///< Every bone and every morph weight.
};

struct ClipEditorOptions {
  Interpolation interpolation = Interpolation::linear;  ///< Of new tracks.
  /// Seconds: a time that is as near to that of a key is taken as the same. >= 0.
  double snap = 1e-3;
};

/// Largest errors at the times of keys that reduce() removes.
struct ReduceOptions {
  double metres = 1e-4;   ///< Translations.
  double radians = 1e-3;  ///< Rotations.
  double factor = 1e-3;   ///< Scales and morph weights.
};

/// Makes or changes a clip by keeping poses as key frames, while it plays: snapshot() is an
/// immutable copy for ClipPlayer::replace_clip() and for Character::clips. Right after insert() the
/// clip gives the inserted pose at that time (unit quaternions to 1e-6).
///
/// A new track is at rest at all other keys; with KeyedTracks::changed only at those before and
/// after it. Tangents of new
/// cubic_spline tracks follow the neighbouring keys (Catmull and Rom), zero at both ends; those of
/// existing tracks stay, and a new key among them gets such a tangent. Times are in seconds. A call
/// that fails changes nothing. One thread at a time.
class SUNDER_API ClipEditor {
 public:
  /// A new clip without keys. @param character  satisfies validate_character(); kept.
  /// @return empty_input without a character; invalid_argument for the options; limit_exceeded: out
  /// of memory.
  [[nodiscard]] static Result<ClipEditor> create(std::shared_ptr<const Character> character,
                                                 std::string name,
                                                 const ClipEditorOptions& options = {});
  /// A copy of a clip. @return also the first fault of the clip, as validate_character().
  [[nodiscard]] static Result<ClipEditor> create(std::shared_ptr<const Character> character,
                                                 const Clip& clip,
                                                 const ClipEditorOptions& options = {});
  ~ClipEditor();
  ClipEditor(ClipEditor&&) noexcept;
  ClipEditor& operator=(ClipEditor&&) noexcept;

  /// Keeps a pose as a key frame; a key at that time is replaced. @param time  finite, >= 0.
  /// @return size_mismatch, non_finite_value, invalid_argument; limit_exceeded: out of memory.
  /// O(bones + keys of the tracks behind that time).
  Status insert(double time, const Pose& pose, KeyedTracks tracks = KeyedTracks::tracked);
  /// Moves all keys of a time to another time, over those that are there.
  /// @return not_found if there is no key; invalid_argument; limit_exceeded: out of memory.
  Status move(double from, double to);
  /// Removes all keys of a time. @return not_found; limit_exceeded: out of memory.
  Status remove(double time);
  /// Removes keys of linear and step tracks that the others reproduce; first and last keys stay.
  /// @return invalid_argument for a negative tolerance; limit_exceeded: out of memory.
  Status reduce(const ReduceOptions& options = {});

  /// Times of all keys of any track, ascending. Allocates.
  [[nodiscard]] std::vector<float> key_times() const;
  /// The clip as it is now; it satisfies the rules of validate_character().
  /// @return empty_input without a track: all keys are at rest, or there is none; limit_exceeded:
  /// out of memory. O(keys), allocates.
  [[nodiscard]] Result<std::shared_ptr<const Clip>> snapshot() const;

 private:
  struct State;
  explicit ClipEditor(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace sunder
