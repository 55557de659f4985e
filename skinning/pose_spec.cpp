#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <optional>

#include "core/internal/find_named.h"
#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

Result<Index> clip_of(const Character& character, const std::variant<std::string, Index>& wanted) {
  if (const std::optional<Index> clip = find_named_clip(character, wanted)) return *clip;
  const std::size_t count = character.clips.size();
  if (const Index* const index = std::get_if<Index>(&wanted))
    return Status::failure(StatusCode::not_found, *index,
                           "clip %u does not exist; the model has %zu clips", *index, count);
  const std::string& name = std::get<std::string>(wanted);
  return Status::failure(StatusCode::not_found, kNone,
                         "no clip is named '%.100s'; `sunder info` lists the model's %zu clips",
                         name.c_str(), count);
}

/// Overwrites the local transforms of rest with those that a spec gives.
class ApplyTo {
 public:
  ApplyTo(const Character& character, Pose& pose) : character_(character), pose_(pose) {}

  template <class Other>  // rest; other specs are not local transforms
  Status operator()(const Other&) const {
    return {};
  }
  Status operator()(const ClipPose& spec) const {
    const Result<Index> clip = clip_of(character_, spec.clip);
    return clip ? sample_clip(character_.clips[*clip], spec.time, pose_) : clip.error();
  }
  Status operator()(const BonesPose& spec) const {
    const auto& bones = character_.skeleton.bones;
    for (const BonesPose::Bone& given : spec.bones) {
      const auto bone = std::find_if(bones.begin(), bones.end(), [&](const Bone& candidate) {
        return candidate.name == given.name;
      });
      if (bone == bones.end())
        return Status::failure(StatusCode::not_found, kNone, "no bone is named '%.100s'",
                               given.name.c_str());
      BoneTransform& local = pose_.parent_from_bone[static_cast<std::size_t>(bone - bones.begin())];
      if (given.translation) local.translation = *given.translation;
      if (given.rotation) local.rotation = *given.rotation;
      if (given.scale) local.scale = *given.scale;
    }
    return {};
  }

 private:
  const Character& character_;
  Pose& pose_;
};

}  // namespace

Result<ModelPose> make_pose(const Character& character, const PoseSpec& spec) {
  if (std::holds_alternative<BindPose>(spec)) return bind_pose(character);
  if (const auto* const given = std::get_if<ModelPose>(&spec)) {
    if (given->model_from_bone.size() != character.skeleton.bones.size())
      return Status::failure(StatusCode::size_mismatch, kNone,
                             "the pose has %zu bones, the character has %zu",
                             given->model_from_bone.size(), character.skeleton.bones.size());
    if (given->morph_weights.size() != character.rest_morph_weights.size())
      return Status::failure(StatusCode::size_mismatch, kNone,
                             "the pose has %zu morph weights, the character has %zu",
                             given->morph_weights.size(), character.rest_morph_weights.size());
    return or_out_of_memory([&]() -> Result<ModelPose> { return *given; });
  }
  Result<Pose> pose = local_rest_pose(character);
  if (!pose) return pose.error();
  if (const Status status = std::visit(ApplyTo(character, *pose), spec); !status) return status;
  ModelPose model_pose;
  if (const Status status = compute_model_pose(character.skeleton, *pose, model_pose); !status)
    return status;
  return model_pose;
}

}  // namespace sunder
