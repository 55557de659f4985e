#pragma once

#include <sunder/core/clip.h>
#include <sunder/core/skeleton.h>

#include <span>

namespace sunder::skinning {

/// Writes the value of a channel that drives a bone, at a finite time.
void sample_channel(const Channel& channel, double time, BoneTransform& bone);

/// Writes the values of a channel of morph weights. @param morph_weights  all weights of the
/// character.
void sample_channel(const Channel& channel, double time, std::span<float> morph_weights);

}  // namespace sunder::skinning
