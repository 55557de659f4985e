#pragma once

#include <sunder/core/character.h>
#include <sunder/tear/torn_asset.h>

#include "tear/internal/surface.h"

namespace sunder::tear {

// What a model copies of its asset, with the room that Room::reserve() asks for: no array is then
// copied twice.

/// @param mesh_count  of the character.
[[nodiscard]] Surface copy_with_room(const Surface& surface, const TornCapacity& capacity,
                                     std::size_t mesh_count);
[[nodiscard]] Character copy_with_room(const Character& character, const TornCapacity& capacity);

}  // namespace sunder::tear
