#pragma once

#include "io/gltf_patch/sound_accessors.h"

namespace sunder::gltf {

/// Whether an animation follows the rules of glTF, up to every key. Also corrects the bounds of its
/// key times.
[[nodiscard]] bool is_animation_sound(const Json& animation, const Json& document,
                                      SoundAccessors& accessors);

}  // namespace sunder::gltf
