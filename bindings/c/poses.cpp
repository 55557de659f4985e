#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cstring>

#include "bindings/c/character.h"

using namespace sunder::c;

extern "C" {

sunder_status sunder_sample_clip(sunder_character character, uint32_t clip, double seconds,
                                 sunder_transform* transforms, float* morph_weights) {
  return guarded([&]() -> sunder_status {
    const CharacterObject* const object = find<CharacterObject>(character);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (transforms == nullptr) return null_pointer("transforms");
    const sunder::Character& model = *object->parts->loaded.character;
    if (clip >= model.clips.size())
      return fail(SUNDER_INDEX_OUT_OF_RANGE, clip, "clip %u of %zu", clip, model.clips.size());
    auto pose = sunder::local_rest_pose(model);
    if (!pose) return report(pose.error());
    if (const auto status = sunder::sample_clip(model.clips[clip], seconds, *pose); !status)
      return report(status);
    std::transform(pose->parent_from_bone.begin(), pose->parent_from_bone.end(), transforms,
                   [](const sunder::BoneTransform& one) { return transform_of(one); });
    if (morph_weights != nullptr)
      std::copy(pose->morph_weights.begin(), pose->morph_weights.end(), morph_weights);
    return SUNDER_OK;
  });
}

sunder_status sunder_compute_matrices(sunder_character character,
                                      const sunder_transform* transforms, double* model_from_bone) {
  return guarded([&]() -> sunder_status {
    const CharacterObject* const object = find<CharacterObject>(character);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (model_from_bone == nullptr) return null_pointer("model_from_bone");
    const sunder::Character& model = *object->parts->loaded.character;
    auto pose = sunder::local_rest_pose(model);
    if (!pose) return report(pose.error());
    if (transforms != nullptr)
      std::transform(transforms, transforms + pose->parent_from_bone.size(),
                     pose->parent_from_bone.begin(),
                     [](const sunder_transform& one) { return transform_of(one); });
    sunder::ModelPose matrices;
    if (const auto status = sunder::compute_model_pose(model.skeleton, *pose, matrices); !status)
      return report(status);
    if (!matrices.model_from_bone.empty())
      std::memcpy(model_from_bone, matrices.model_from_bone.front().data(),
                  matrices.model_from_bone.size() * sizeof(sunder::Affine3d));
    return SUNDER_OK;
  });
}

}  // extern "C"
