#pragma once

#include <sunder/animation/clip_editor.h>
#include <sunder/core/clip.h>

namespace sunder::animation {

/// Removes inner keys of a linear or step channel that interpolation between the remaining ones
/// gives within the tolerances. Splines stay. @throws std::bad_alloc, before anything changed.
void reduce_keys(Channel& channel, const ReduceOptions& options);

}  // namespace sunder::animation
