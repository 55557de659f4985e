#pragma once

#include <sunder/core/character.h>

#include <vector>

namespace sunder {

/// Per bone: whether a clip has a channel for its transform.
[[nodiscard]] inline std::vector<bool> bones_moved_by_clips(const Character& character) {
  std::vector<bool> moved(character.skeleton.bones.size(), false);
  for (const Clip& clip : character.clips)
    for (const Channel& channel : clip.channels)
      if (channel.target != ChannelTarget::morph_weights) moved[channel.index] = true;
  return moved;
}

}  // namespace sunder
