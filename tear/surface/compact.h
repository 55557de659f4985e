#pragma once

#include <sunder/tear/torn_model.h>

namespace sunder {

/// Removes retired triangles and the vertices that no triangle uses. Numbers change; everything
/// else is bit-identical.
/// @return where each element came from. O(size of the character).
CompactMaps compact(Character& character);

}  // namespace sunder
