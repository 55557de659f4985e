#pragma once

#include <sunder/animation/blend.h>
#include <sunder/core/character.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace sunder {

/// The course of a layer whose clip is over.
enum class PlayMode : std::uint8_t {
  loop,       ///< Begins again.
  ping_pong,  ///< Turns around at both ends.
  once,       ///< Holds the last pose; with a negative speed the first one.
};

/// How the pose of a layer joins those of the layers below it.
enum class LayerKind : std::uint8_t {
  whole,     ///< Replaces all bones; those that the clip does not animate are at rest.
  animated,  ///< Replaces what the clip animates and leaves the rest as it is.
  additive,  ///< Adds its difference to a reference pose.
};

/// The course of a fade over its duration, from 0 to 1.
enum class Easing : std::uint8_t {
  linear,    ///< t
  smooth,    ///< 3 t^2 - 2 t^3: begins and ends without a jump in speed.
  ease_in,   ///< t^2
  ease_out,  ///< 1 - (1 - t)^2
};

struct LayerOptions {
  LayerKind kind = LayerKind::whole;
  PlayMode mode = PlayMode::loop;
  double time = 0.0;  ///< Seconds into the clip at which it starts.
  double speed =
      1.0;  ///< Seconds of the clip per second; negative plays backwards, 0 stands still.
  float weight = 1.0f;   ///< In [0, 1].
  double fade_in = 0.0;  ///< Seconds from weight 0 to `weight`.
  /// A clip that is played once fades out over its last seconds and ends with the clip. 0: it holds
  /// its last pose.
  double fade_out = 0.0;
  Easing easing = Easing::smooth;
  std::shared_ptr<const BoneMask> mask = nullptr;  ///< Null: all bones.
  /// The pose to which an additive layer takes its difference. Null: the rest pose.
  std::shared_ptr<const Pose> reference = nullptr;
};

/// A layer of a ClipPlayer. Ids of layers that ended are never valid again.
struct LayerId {
  std::uint32_t slot = kNone;
  std::uint32_t generation = 0;

  bool operator==(const LayerId&) const = default;
};

struct LayerState {
  double time = 0.0;     ///< In the clip, seconds.
  float weight = 0.0f;   ///< With its fade.
  bool is_over = false;  ///< A clip played once is at its end.
};

/// A ClipPlayer as plain data, to be kept and restored.
struct ClipPlayerState {
  struct Fade {
    float from = 1.0f, to = 1.0f;
    double elapsed = 0.0, seconds = 0.0;
    Easing easing = Easing::linear;
  };
  struct Layer {
    std::uint32_t slot = 0;  ///< As in its LayerId.
    std::shared_ptr<const Clip> clip;
    LayerOptions options;
    Fade fade;
    double phase = 0.0;  ///< Seconds into the period of the clip.
    bool ends_after_fade = false, ends_others_after_fade = false;
  };
  std::vector<Layer> layers;               ///< The lowest one first.
  std::vector<std::uint32_t> generations;  ///< Per slot.
  std::vector<std::uint32_t> unused;       ///< Slots, the next one last.
};

/// One of a character's clips, for ClipPlayer::play(); keeps the character. Null if it has none of
/// that index.
[[nodiscard]] SUNDER_API std::shared_ptr<const Clip> clip_of(
    std::shared_ptr<const Character> character, std::uint32_t clip);

/// Plays clips on top of one another: first the layers of kind `whole`, then `animated`, then
/// `additive`, of one kind the later ones above the earlier ones. The lowest layer lies on the rest
/// pose. Clips are shared and immutable: an edited clip is handed over by replace_clip().
///
/// revision() says whether the pose may differ from the last one; as long as it stays the same, an
/// engine needs neither evaluate() nor a palette. One thread at a time. The same calls give the
/// same bits. Times are in seconds.
class SUNDER_API ClipPlayer {
 public:
  /// @param character  satisfies validate_character(); kept.
  /// @return empty_input without a character; limit_exceeded: out of memory.
  [[nodiscard]] static Result<ClipPlayer> create(std::shared_ptr<const Character> character);
  ~ClipPlayer();
  ClipPlayer(ClipPlayer&&) noexcept;
  ClipPlayer& operator=(ClipPlayer&&) noexcept;

  /// Starts a layer. @param clip  kept.
  /// @return the first fault of the clip, as validate_character(); empty_input without a clip;
  /// invalid_argument, size_mismatch for the options; limit_exceeded: out of memory. O(keys),
  /// allocates.
  Result<LayerId> play(std::shared_ptr<const Clip> clip, const LayerOptions& options = {});
  /// Starts a layer of kind `whole` that fades in over all others of this kind with the same mask
  /// object, and ends them when it has its whole weight of 1. `options.fade_in` is the duration. A
  /// mask should consist of zeros and ones then: elsewhere the ended layers show through.
  /// @return as play(); invalid_argument for another kind or weight.
  Result<LayerId> cross_fade(std::shared_ptr<const Clip> clip, const LayerOptions& options);
  /// Puts another clip in place of a layer's, at the same time: for clips that are edited while
  /// they play. @return as play(); not_found.
  Status replace_clip(LayerId layer, std::shared_ptr<const Clip> clip);

  /// Lets the weight of a layer go to another one within some seconds; from then on it takes the
  /// place of any other fade. @return not_found, invalid_argument.
  Status fade(LayerId layer, float weight, double seconds, Easing easing = Easing::smooth);
  /// Fades a layer out and ends it. @return as fade().
  Status stop(LayerId layer, double seconds = 0.0, Easing easing = Easing::smooth);
  /// Ends all layers.
  void stop_all();
  /// @param time  in the clip, clamped to it. @return not_found, non_finite_value.
  Status seek(LayerId layer, double time);
  /// @return not_found, non_finite_value.
  Status set_speed(LayerId layer, double speed);

  [[nodiscard]] std::uint32_t layer_count() const;
  /// @return not_found if the layer ended.
  [[nodiscard]] Result<LayerState> layer(LayerId layer) const;

  /// Lets time pass: clips, fades, ends. @param seconds  finite, >= 0.
  /// @return non_finite_value, invalid_argument. O(layers), no allocation.
  Status advance(double seconds);
  /// Increases when the pose may have changed. A layer that stands still, is over, has no weight,
  /// lies below one that hides it, or plays a clip of single keys changes nothing.
  [[nodiscard]] std::uint64_t revision() const;
  /// Whether revision() increased since the last evaluate(); true before the first one.
  [[nodiscard]] bool has_changed() const;

  /// The layers, as plain data. @return limit_exceeded: out of memory.
  [[nodiscard]] Result<ClipPlayerState> state() const;
  /// Makes the player one whose state was kept: it goes on with the same bits and the same ids.
  /// @return as play() for the clips and options; invalid_argument, index_out_of_range for slots
  /// that do not fit together; nothing is changed then.
  Status restore(const ClipPlayerState& state);

  /// Writes the pose of the moment. @param pose  resized to fit.
  /// @return limit_exceeded: out of memory (nothing is written). O(bones x visible layers +
  /// channels); no allocation if the pose fits.
  Status evaluate(Pose& pose);

 private:
  struct State;
  explicit ClipPlayer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace sunder
