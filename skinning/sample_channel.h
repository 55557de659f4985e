#pragma once

#include <sunder/core/clip.h>
#include <sunder/core/skeleton.h>

#include <span>

namespace sunder::skinning {

/// Writes what a channel of a bone drives, as it is at a finite time.
void sample_channel(const Channel& channel, double time, BoneTransform& bone);

/// Writes what a channel of morph weights drives.
/// @param morph_weights  all of the character's.
void sample_channel(const Channel& channel, double time, std::span<float> morph_weights);

}  // namespace sunder::skinning
