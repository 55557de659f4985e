#include "scene/actor/playback.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <new>

namespace sunder::scene {

ClipPlayer& Playback::player(const std::shared_ptr<const Character>& character, double now) {
  if (!player_) {
    Result<ClipPlayer> made = ClipPlayer::create(character);
    if (!made) throw std::bad_alloc();
    player_.emplace(std::move(*made));
  }
  advance(now);
  return *player_;
}

void Playback::advance(double now) {
  if (is_playing()) (void)player_->advance(std::max(0.0, now - now_));
  now_ = now;
}

Status Playback::sample(const Character& character, ModelPose& pose) {
  const std::uint64_t revision = player_->revision();
  if (Status status = player_->evaluate(local_); !status) return status;
  if (Status status = compute_model_pose(character.skeleton, local_, pose); !status) return status;
  sampled_revision_ = revision;
  return {};
}

}  // namespace sunder::scene
