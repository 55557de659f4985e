#pragma once

#include <sunder/animation/clip_player.h>

#include <memory>
#include <optional>

namespace sunder::scene {

/// The clips that an instance plays.
class Playback {
 public:
  /// The player, which is made at the first call. @param now  time of the scene, seconds. @throws
  /// std::bad_alloc
  ClipPlayer& player(const std::shared_ptr<const Character>& character, double now);
  void stop() {
    if (player_) player_->stop_all();
  }
  [[nodiscard]] bool is_playing() const { return player_ && player_->layer_count() > 0; }
  /// Time goes on; nothing is sampled.
  void advance(double now);
  /// Whether the pose differs from that of the last sample().
  [[nodiscard]] bool needs_sample() const {
    return is_playing() && player_->revision() != sampled_revision_;
  }
  /// Computes the pose of the moment. Allocates in the first call.
  Status sample(const Character& character, ModelPose& pose);
  void note_sampled() { sampled_revision_ = player_->revision(); }

  /// Empty if nothing was ever played.
  [[nodiscard]] const std::optional<ClipPlayer>& known_player() const { return player_; }
  /// The time of the scene up to which the player advanced.
  [[nodiscard]] double now() const { return now_; }

 private:
  std::optional<ClipPlayer> player_;
  Pose local_;
  double now_ = 0;
  std::uint64_t sampled_revision_ = 0;
};

}  // namespace sunder::scene
