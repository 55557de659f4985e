#pragma once

#include <sunder/core/api.h>
#include <sunder/core/clip.h>
#include <sunder/core/skeleton.h>

#include <cstdint>
#include <span>

namespace sunder::skinning {

/// Writes the value of a channel that drives a bone, at a finite time.
SUNDER_API void sample_channel(const Channel& channel, double time, BoneTransform& bone);

/// Writes the values of a channel of morph weights. @param morph_weights  all weights of the
/// character.
SUNDER_API void sample_channel(const Channel& channel, double time, std::span<float> morph_weights);

/// The same bits, without a search where time goes on in small steps. @param cursor  the key at or
/// before the time of the last call; updated. Any number is a valid start.
SUNDER_API void sample_channel(const Channel& channel, double time, std::uint32_t& cursor,
                               BoneTransform& bone);
SUNDER_API void sample_channel(const Channel& channel, double time, std::uint32_t& cursor,
                               std::span<float> morph_weights);

}  // namespace sunder::skinning
