#pragma once

#include <sunder/core/skeleton.h>
#include <sunder/scene/scene.h>

namespace sunder::scene {

/// The clip that an instance plays.
class Playback {
 public:
  /// @param clip  of the character. @param now  time of the scene, seconds.
  void start(Index clip, const PlayOptions& options, double now) {
    clip_ = clip;
    options_ = options;
    time_ = options.start;
    now_ = now;
    is_new_ = true;
  }
  void stop() { clip_ = kNone; }
  [[nodiscard]] bool is_playing() const { return clip_ != kNone; }
  /// Time goes on; nothing is sampled.
  void advance(const Character& character, double now);
  /// Whether the pose differs from that of the last sample().
  [[nodiscard]] bool needs_sample() const { return is_playing() && is_new_; }
  /// Samples the clip. Allocates in the first call. @throws std::bad_alloc
  Status sample(const Character& character, ModelPose& pose);

 private:
  Index clip_ = kNone;
  PlayOptions options_;
  double time_ = 0;      ///< In the clip.
  double now_ = 0;       ///< The time of the scene at that moment.
  bool is_new_ = false;  ///< Whether the time changed since the last sample.
  Pose local_;
};

}  // namespace sunder::scene
