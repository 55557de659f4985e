#include "particles/clusters/check_pose.h"

#include <cmath>

namespace sunder::particles {

Status check_pose(const CharacterLink& character, const ModelPose& pose) {
  if (pose.model_from_bone.size() != character.bone_count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu bones, the character has %zu",
                           pose.model_from_bone.size(), character.bone_count);
  if (pose.morph_weights.size() != character.morph_weight_count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu morph weights, the character has %zu",
                           pose.morph_weights.size(), character.morph_weight_count);
  for (std::uint32_t bone = 0; bone < pose.model_from_bone.size(); ++bone)
    if (!pose.model_from_bone[bone].matrix().allFinite())
      return Status::failure(StatusCode::non_finite_value, bone,
                             "the pose of bone %u is not finite", bone);
  for (std::uint32_t i = 0; i < pose.morph_weights.size(); ++i)
    if (!std::isfinite(pose.morph_weights[i]))
      return Status::failure(StatusCode::non_finite_value, i,
                             "morph weight %u of the pose is not finite", i);
  return {};
}

}  // namespace sunder::particles
