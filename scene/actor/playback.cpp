#include "scene/actor/playback.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>

namespace sunder::scene {

void Playback::advance(const Character& character, double now) {
  if (!is_playing()) return;
  const double duration = static_cast<double>(character.clips[clip_].duration);
  const double before = time_;
  time_ += options_.speed * (now - now_);
  now_ = now;
  if (!options_.is_looped || duration <= 0)
    time_ = std::clamp(time_, 0.0, std::max(duration, 0.0));
  else
    time_ -= duration * std::floor(time_ / duration);
  is_new_ |= time_ != before;
}

Status Playback::sample(const Character& character, ModelPose& pose) {
  if (local_.parent_from_bone.empty()) {
    Result<Pose> rest = local_rest_pose(character);
    if (!rest) return rest.error();
    local_ = std::move(*rest);
  }
  // Bones that this clip does not move may have been moved by the one before.
  for (std::size_t bone = 0; bone < local_.parent_from_bone.size(); ++bone)
    local_.parent_from_bone[bone] = character.skeleton.bones[bone].rest;
  local_.morph_weights = character.rest_morph_weights;
  if (Status status = sample_clip(character.clips[clip_], time_, local_); !status) return status;
  if (Status status = compute_model_pose(character.skeleton, local_, pose); !status) return status;
  is_new_ = false;
  return {};
}

}  // namespace sunder::scene
