#include "scene/snapshot/check_pose.h"

#include <cmath>

namespace sunder::scene {
namespace {

constexpr double kMost = 1e12;

}  // namespace

Status check_pose(const Character& character, const ModelPose& pose) {
  if (pose.model_from_bone.size() != character.skeleton.bones.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu matrices; the skeleton has %zu bones",
                           pose.model_from_bone.size(), character.skeleton.bones.size());
  if (pose.morph_weights.size() != character.rest_morph_weights.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu morph weights; the character has %zu",
                           pose.morph_weights.size(), character.rest_morph_weights.size());
  for (std::size_t bone = 0; bone < pose.model_from_bone.size(); ++bone)
    if (!pose.model_from_bone[bone].matrix().allFinite())
      return Status::failure(StatusCode::non_finite_value, static_cast<Index>(bone),
                             "the matrix of bone %zu is not finite", bone);
  for (std::size_t bone = 0; bone < pose.model_from_bone.size(); ++bone)
    if (pose.model_from_bone[bone].matrix().cwiseAbs().maxCoeff() > kMost)
      return Status::failure(StatusCode::invalid_argument, static_cast<Index>(bone),
                             "the matrix of bone %zu has a number above %g", bone, kMost);
  for (std::size_t i = 0; i < pose.morph_weights.size(); ++i)
    if (!std::isfinite(pose.morph_weights[i]))
      return Status::failure(StatusCode::non_finite_value, static_cast<Index>(i),
                             "morph weight %zu is not finite", i);
  for (std::size_t i = 0; i < pose.morph_weights.size(); ++i)
    if (std::abs(double{pose.morph_weights[i]}) > kMost)
      return Status::failure(StatusCode::invalid_argument, static_cast<Index>(i),
                             "morph weight %zu is above %g", i, kMost);
  return {};
}

}  // namespace sunder::scene
