// What plays, and poses from outside.

#include <sunder/animation/clip_player.h>

#include <algorithm>
#include <cstring>

#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

sunder_layer layer_handle(const LayerId& id) {
  return (std::uint64_t{id.generation} + 1) << 32u | id.slot;
}

LayerId layer_of(sunder_layer layer) {
  if (layer >> 32u == 0) return {};
  return {static_cast<std::uint32_t>(layer), static_cast<std::uint32_t>((layer >> 32u) - 1)};
}

sunder_status read_options(const sunder_layer_options& from, const Skeleton& skeleton,
                           LayerOptions& options) {
  SUNDER_C_TRY(check_enum(from.kind, SUNDER_LAYER_ADDITIVE, "kind"));
  SUNDER_C_TRY(check_enum(from.mode, SUNDER_PLAY_ONCE, "mode"));
  SUNDER_C_TRY(check_enum(from.easing, SUNDER_EASE_OUT, "easing"));
  options.kind = static_cast<LayerKind>(from.kind);
  options.mode = static_cast<PlayMode>(from.mode);
  options.easing = static_cast<Easing>(from.easing);
  options.time = from.time;
  options.speed = from.speed;
  options.weight = from.weight;
  options.fade_in = from.fade_in;
  options.fade_out = from.fade_out;
  if (from.mask_bone == kNone) return SUNDER_OK;
  auto mask = subtree_mask(skeleton, from.mask_bone);
  if (!mask) return report(mask.error());
  options.mask = std::make_shared<const BoneMask>(std::move(*mask));
  return SUNDER_OK;
}

/// Starts a layer by `start(scene, id, options)`.
template <class Start>
sunder_status start_layer(sunder_scene scene, sunder_instance instance, std::uint32_t clip,
                          const sunder_layer_options* options, sunder_layer* layer, Start&& start) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    SUNDER_C_TRY(check_options(options, "options"));
    const Character& character = *found.instance->asset()->character();
    if (clip >= character.clips.size())
      return fail(SUNDER_INDEX_OUT_OF_RANGE, clip, "clip %u of %zu", clip, character.clips.size());
    LayerOptions wanted;
    if (options != nullptr) SUNDER_C_TRY(read_options(*options, character.skeleton, wanted));
    const Result<LayerId> started = start(found, wanted);
    if (!started) return report(started.error());
    if (layer != nullptr) *layer = layer_handle(*started);
    return SUNDER_OK;
  });
}

/// Calls `call` with the player of an instance.
template <class Call>
sunder_status call_player(sunder_scene scene, sunder_instance instance, Call&& call) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    ClipPlayer* const player = found.scene->scene.player(instance_of(instance));
    if (player == nullptr) throw std::bad_alloc();
    return report(call(*player));
  });
}

/// Sets a pose, of which `copy_bones` fills the bones.
template <class AnyPose, class CopyBones>
sunder_status set_pose(sunder_scene scene, sunder_instance instance, const void* bones,
                       const float* morph_weights, CopyBones&& copy_bones) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    if (bones == nullptr) return null_pointer("bones");
    AnyPose pose;
    copy_bones(pose);
    pose.morph_weights = found.instance->asset()->character()->rest_morph_weights;
    if (morph_weights != nullptr)
      std::copy_n(morph_weights, pose.morph_weights.size(), pose.morph_weights.begin());
    return report(found.scene->scene.set_pose(instance_of(instance), pose));
  });
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_layer_options sunder_default_layer_options(void) {
  const sunder::LayerOptions defaults;
  sunder_layer_options options = {};
  options.struct_size = sizeof options;
  options.easing = static_cast<uint32_t>(defaults.easing);
  options.speed = defaults.speed;
  options.weight = defaults.weight;
  options.mask_bone = SUNDER_NONE;
  return options;
}

sunder_status sunder_play(sunder_scene scene, sunder_instance instance, uint32_t clip,
                          const sunder_layer_options* options, sunder_layer* layer) {
  return start_layer(scene, instance, clip, options, layer,
                     [&](const Found& found, const sunder::LayerOptions& wanted) {
                       return found.scene->scene.play(instance_of(instance), clip, wanted);
                     });
}

sunder_status sunder_cross_fade(sunder_scene scene, sunder_instance instance, uint32_t clip,
                                const sunder_layer_options* options, sunder_layer* layer) {
  return start_layer(scene, instance, clip, options, layer,
                     [&](const Found& found,
                         const sunder::LayerOptions& wanted) -> sunder::Result<sunder::LayerId> {
                       sunder::ClipPlayer* const player =
                           found.scene->scene.player(instance_of(instance));
                       if (player == nullptr) throw std::bad_alloc();
                       return player->cross_fade(
                           sunder::clip_of(found.instance->asset()->character(), clip), wanted);
                     });
}

sunder_status sunder_fade_layer(sunder_scene scene, sunder_instance instance, sunder_layer layer,
                                float weight, double seconds) {
  return call_player(scene, instance, [&](sunder::ClipPlayer& player) {
    return player.fade(layer_of(layer), weight, seconds);
  });
}

sunder_status sunder_stop_layer(sunder_scene scene, sunder_instance instance, sunder_layer layer,
                                double seconds) {
  return call_player(scene, instance, [&](sunder::ClipPlayer& player) {
    return player.stop(layer_of(layer), seconds);
  });
}

sunder_status sunder_seek_layer(sunder_scene scene, sunder_instance instance, sunder_layer layer,
                                double time) {
  return call_player(scene, instance, [&](sunder::ClipPlayer& player) {
    return player.seek(layer_of(layer), time);
  });
}

sunder_status sunder_set_layer_speed(sunder_scene scene, sunder_instance instance,
                                     sunder_layer layer, double speed) {
  return call_player(scene, instance, [&](sunder::ClipPlayer& player) {
    return player.set_speed(layer_of(layer), speed);
  });
}

sunder_status sunder_get_layer(sunder_scene scene, sunder_instance instance, sunder_layer layer,
                               sunder_layer_state* state) {
  SUNDER_C_TRY(check_struct(state, "state"));
  return call_player(scene, instance, [&](sunder::ClipPlayer& player) {
    const auto found = player.layer(layer_of(layer));
    if (!found) return found.error();
    *state = {sizeof(sunder_layer_state), found->is_over ? 1u : 0u, found->time, found->weight, 0};
    return sunder::Status();
  });
}

sunder_status sunder_stop(sunder_scene scene, sunder_instance instance) {
  return call_scene(scene, [&](sunder::Scene& of) { return of.stop(instance_of(instance)); });
}

sunder_status sunder_set_matrices(sunder_scene scene, sunder_instance instance,
                                  const double* model_from_bone, uint32_t bone_count,
                                  const float* morph_weights) {
  return set_pose<sunder::ModelPose>(
      scene, instance, model_from_bone, morph_weights, [&](sunder::ModelPose& pose) {
        pose.model_from_bone.resize(bone_count);
        if (bone_count > 0)
          std::memcpy(pose.model_from_bone.front().data(), model_from_bone,
                      bone_count * sizeof(sunder::Affine3d));
      });
}

sunder_status sunder_set_transforms(sunder_scene scene, sunder_instance instance,
                                    const sunder_transform* transforms, uint32_t bone_count,
                                    const float* morph_weights) {
  return set_pose<sunder::Pose>(scene, instance, transforms, morph_weights,
                                [&](sunder::Pose& pose) {
                                  for (uint32_t i = 0; i < bone_count; ++i)
                                    pose.parent_from_bone.push_back(transform_of(transforms[i]));
                                });
}

sunder_status sunder_get_pose(sunder_scene scene, sunder_instance instance,
                              const double** model_from_bone, uint32_t* bone_count) {
  Found found;
  SUNDER_C_TRY(find_instance(scene, instance, found));
  if (model_from_bone == nullptr) return null_pointer("model_from_bone");
  if (bone_count == nullptr) return null_pointer("bone_count");
  const auto& matrices = found.instance->pose().model_from_bone;
  *model_from_bone = matrices.empty() ? nullptr : matrices.front().data();
  *bone_count = static_cast<uint32_t>(matrices.size());
  return SUNDER_OK;
}

}  // extern "C"
