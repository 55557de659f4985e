#pragma once

#include <optional>
#include <vector>

#include "scene/actor/actor.h"
#include "scene/snapshot/layers.h"
#include "scene/snapshot/operations.h"

namespace sunder::scene {

template <class Archive>
void transfer(Archive& archive, StateArrays& of) {
  auto& [version, indices, numbers, floats, doubles] = of;
  archive(version, indices, numbers, floats, doubles);
}
template <class Archive>
void transfer(Archive& archive, CharacterInstance::TissueState& of) {
  auto& [particles, body] = of;
  archive(particles, body);
}
template <class Archive>
void transfer(Archive& archive, Actor::State& of) {
  auto& [is_visible, has_new_pose, screen_height, now, last_operation, player, player_now,
         needs_sample, pose, next_pose] = of;
  archive(is_visible, has_new_pose, screen_height, now, last_operation, player, player_now,
          needs_sample);
  for (ModelPose* one : {&pose, &next_pose}) {
    bool has_pose = !one->model_from_bone.empty();
    archive(has_pose);
    if (has_pose) archive(*one);
  }
}

/// An instance as a snapshot holds it.
struct SavedInstance {
  std::uint64_t asset = 0;   ///< digest_of() its asset.
  bool is_prepared = false;  ///< Whether it has a torn model.
  std::vector<Operation> done, undone;
  std::optional<CharacterInstance::TissueState> tissue;
  Actor::State actor;
};

}  // namespace sunder::scene
