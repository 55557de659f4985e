#pragma once

#include <sunder/core/skeleton.h>
#include <sunder/scene/scene.h>

namespace sunder::scene {

/// The clip that an instance plays.
class Playback {
 public:
  struct State {
    Index clip = kNone;
    PlayOptions options;
    double time = 0;      ///< In the clip.
    double now = 0;       ///< The time of the scene at that moment.
    bool is_new = false;  ///< Whether the time changed since the last sample.
  };
  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

  /// @param clip  of the character. @param now  time of the scene, seconds.
  void start(Index clip, const PlayOptions& options, double now) {
    state_ = {clip, options, options.start, now, true};
  }
  void stop() { state_.clip = kNone; }
  [[nodiscard]] bool is_playing() const { return state_.clip != kNone; }
  /// Time goes on; nothing is sampled.
  void advance(const Character& character, double now);
  /// Whether the pose differs from that of the last sample().
  [[nodiscard]] bool needs_sample() const { return is_playing() && state_.is_new; }
  /// Samples the clip. Allocates in the first call. @throws std::bad_alloc
  Status sample(const Character& character, ModelPose& pose);

 private:
  State state_;
  Pose local_;
};

}  // namespace sunder::scene
