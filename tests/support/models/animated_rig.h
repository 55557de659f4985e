#pragma once

#include <sunder/core/character.h>

#include "support/machine/random.h"

namespace sunder::test {

/// A tube on a random tree of bones inside it, with random clips.
struct AnimatedRig {
  std::uint32_t bones = 8;       ///< At least 2.
  std::uint32_t influences = 4;  ///< Largest number per vertex.
  std::uint32_t clips = 3;
  double wildest = 1.5;         ///< Largest rotation of a bone by a clip, radians.
  bool is_bent_at_rest = true;  ///< Whether the rest pose is not that of bind.
};

/// Between 2 and 200 bones, 1 to 12 influences, 1 to 8 or 60 clips, gentle or wild.
[[nodiscard]] AnimatedRig any_animated_rig(Random& random);
[[nodiscard]] Character make_animated_rig(const AnimatedRig& wanted, Random& random);

}  // namespace sunder::test
