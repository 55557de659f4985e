#pragma once

#include <sunder/core/clip.h>

#include <span>

#include "io/gltf/glb.h"

namespace sunder::gltf {

/// Appends the keys of a channel to a draft as accessors.
/// @param values  those of the channel, or of the part of it that drives one node.
/// @param components  1, 3 or 4 numbers per element.
/// @return a sampler of an animation.
[[nodiscard]] Json add_sampler(GlbDraft& draft, const Channel& channel,
                               std::span<const float> values, std::uint32_t components);

/// The values of a rotation channel with keys of unit length, which glTF requires; a pose would
/// normalise them anyway. Tangents stay.
[[nodiscard]] std::vector<float> unit_rotations(const Channel& channel);

}  // namespace sunder::gltf
