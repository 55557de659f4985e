#pragma once

#include <sunder/core/character.h>

#include <cstdint>
#include <vector>

namespace sunder::skinning {

/// The times of a clip at which poses are taken, ascending, in seconds.
struct ClipTimes {
  std::vector<double> fit, held_out;
  /// Per time to fit: the share of the clip that lasts around it, times their number.
  std::vector<double> durations;
};

/// Chooses times of all clips by how far the bones move in between: at equal lengths of the path
/// through pose space, in which the bone that turns farthest counts, so a clip is sampled densely
/// where it is fast and hardly where it stands still. Held-out times are halfway between those to
/// fit. A clip that does not move gives one time to fit and none to hold out.
/// @param character  satisfies validate_character().
/// @param most       largest number of times of a clip to fit, at least 1.
/// @return one per clip. O(clips x bones x 32 to 256).
[[nodiscard]] std::vector<ClipTimes> times_of_clips(const Character& character, std::uint32_t most);

}  // namespace sunder::skinning
