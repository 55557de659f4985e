#include "scene/actor/playback.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>

namespace sunder::scene {

void Playback::advance(const Character& character, double now) {
  if (!is_playing()) return;
  const double duration = static_cast<double>(character.clips[state_.clip].duration);
  const double before = state_.time;
  state_.time += state_.options.speed * (now - state_.now);
  state_.now = now;
  if (!state_.options.is_looped || duration <= 0)
    state_.time = std::clamp(state_.time, 0.0, std::max(duration, 0.0));
  else
    state_.time -= duration * std::floor(state_.time / duration);
  state_.is_new |= state_.time != before;
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
  if (Status status = sample_clip(character.clips[state_.clip], state_.time, local_); !status)
    return status;
  if (Status status = compute_model_pose(character.skeleton, local_, pose); !status) return status;
  state_.is_new = false;
  return {};
}

}  // namespace sunder::scene
