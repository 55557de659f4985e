#include "skinning/internal/character_pose.h"

#include <sunder/skinning/deform.h>

#include <cmath>

namespace sunder {

Status CharacterPose::check(const Character& character, const ModelPose& pose) {
  const std::size_t bone_count = character.skeleton.bones.size();
  if (pose.model_from_bone.size() != bone_count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu bones, the character has %zu",
                           pose.model_from_bone.size(), bone_count);
  if (pose.morph_weights.size() != character.rest_morph_weights.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu morph weights, the character has %zu",
                           pose.morph_weights.size(), character.rest_morph_weights.size());
  for (std::uint32_t bone = 0; bone < bone_count; ++bone)
    if (!pose.model_from_bone[bone].matrix().allFinite())
      return Status::failure(StatusCode::non_finite_value, bone,
                             "the pose of bone %u '%.80s' is not finite", bone,
                             character.skeleton.bones[bone].name.c_str());
  for (std::uint32_t i = 0; i < pose.morph_weights.size(); ++i)
    if (!std::isfinite(pose.morph_weights[i]))
      return Status::failure(StatusCode::non_finite_value, i,
                             "morph weight %u of the pose is not finite", i);
  return {};
}

Status CharacterPose::set(const Character& character, const ModelPose& pose) {
  if (Status status = check(character, pose); !status) return status;
  palettes_.resize(character.skins.size());
  for (std::size_t skin = 0; skin < character.skins.size(); ++skin) {
    palettes_[skin].resize(character.skins[skin].bones.size());
    if (Status status = compute_palette(character.skins[skin], pose, palettes_[skin]); !status)
      return status;
  }
  morph_weights_ = pose.morph_weights;
  return {};
}

}  // namespace sunder
