#pragma once

#include <vector>

#include "scene/actor/actor.h"
#include "scene/snapshot/operations.h"

namespace sunder::scene {

template <class Archive>
void transfer(Archive& archive, PlayOptions& of) {
  auto& [start, speed, is_looped] = of;
  archive(start, speed, is_looped);
}
template <class Archive>
void transfer(Archive& archive, Playback::State& of) {
  auto& [clip, options, time, now, is_new] = of;
  archive(clip, options, time, now, is_new);
}
template <class Archive>
void transfer(Archive& archive, Actor::State& of) {
  auto& [is_visible, has_new_pose, screen_height, now, last_operation, playback, pose, next_pose] =
      of;
  archive(is_visible, has_new_pose, screen_height, now, last_operation, playback);
  for (ModelPose* one : {&pose, &next_pose}) {
    bool has_pose = !one->model_from_bone.empty();
    archive(has_pose);
    if (has_pose) archive(*one);
  }
}

/// An instance as a snapshot holds it.
struct SavedInstance {
  std::uint64_t character = 0;  ///< digest_of() its character.
  bool is_prepared = false;     ///< Whether it has a torn model.
  std::vector<Operation> done, undone;
  Actor::State actor;
};

}  // namespace sunder::scene
