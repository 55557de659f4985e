#pragma once

#include <sunder/core/character.h>
#include <sunder/tear/torn_asset.h>

namespace sunder::tear {

/// Whether a capacity limits vertices and triangles alone, and nothing is allocated in advance.
[[nodiscard]] constexpr bool is_limit(const TornCapacity& capacity) {
  return capacity.operations == kNone;
}

/// Checks what operations have added to a character so far against such a limit. O(meshes).
/// @throws CapacityExceeded
void check_growth(const TornCapacity& capacity, const Character& source, const Character& torn);

}  // namespace sunder::tear
