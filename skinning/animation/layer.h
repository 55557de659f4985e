#pragma once

#include <sunder/animation/clip_player.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace sunder::animation {

/// A weight on its way from one value to another.
struct Fade {
  float from = 1.0f, to = 1.0f;
  double elapsed = 0.0, seconds = 0.0;
  Easing easing = Easing::linear;

  [[nodiscard]] bool is_over() const { return elapsed >= seconds; }
  [[nodiscard]] float weight() const;
};

/// The parts of one bone that a clip animates.
struct AnimatedBone {
  std::uint32_t bone = 0;
  bool has_translation = false, has_rotation = false, has_scale = false;
};

/// The parts of a pose that a clip animates, found once.
struct AnimatedParts {
  std::vector<AnimatedBone> bones;           ///< Each bone once.
  std::vector<std::uint32_t> morph_weights;  ///< Ascending.
  double duration = 0.0;                     ///< Of the last key.
  bool is_constant = true;                   ///< Each channel has a single key.
};

[[nodiscard]] AnimatedParts animated_parts(const Clip& clip);

/// A clip that plays.
struct Layer {
  std::shared_ptr<const Clip> clip;
  AnimatedParts parts;
  std::vector<std::uint32_t> cursors;  ///< Per channel: the key at which it was sampled last.
  LayerOptions options;
  Fade fade;
  /// Seconds into the period: of ping_pong the way there and back, else the clip.
  double phase = 0.0;
  bool ends_after_fade = false;
  bool ends_others_after_fade = false;

  /// Time in the clip.
  [[nodiscard]] double time() const;
  [[nodiscard]] double period() const;
  [[nodiscard]] bool is_over() const;
  /// Whether it shows nothing of the layers below it.
  [[nodiscard]] bool is_opaque() const;

  void seek(double time);
  void start_fade(float weight, double seconds, Easing easing);
  /// @return whether its pose or its weight changed.
  bool advance(double seconds);
  /// Overwrites what the clip animates. @param pose  of the character.
  void sample(Pose& pose);

 private:
  bool advance_clip(double seconds);
  void begin_last_fade();
};

/// @param rest, other  of the character; `other` is overwritten as a whole.
/// @param delta        scratch.
/// @param pose         the layers below, and from then on also this one.
void apply(Layer& layer, const Pose& rest, Pose& other, PoseDelta& delta, Pose& pose);

}  // namespace sunder::animation
