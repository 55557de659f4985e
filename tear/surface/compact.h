#pragma once

#include <sunder/tear/torn_model.h>

namespace sunder {

/// Removes retired triangles and the vertices that no triangle uses. Indices change; everything
/// else is bit-identical. O(size of the character).
/// @return the old index of each element.
CompactMaps compact(Character& character);

}  // namespace sunder
