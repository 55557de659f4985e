#pragma once

#include <sunder/core/character.h>

#include <array>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// The cracks of a source: pairs of border edges with the same ends in bind space, whose vertices
/// the pose moves apart because their weights or morph displacements differ. Each pair is listed
/// from both sides, ascending. An edge where more than two borders meet is none.
/// O(triangles + borders log borders)
[[nodiscard]] std::vector<std::array<Index, 2>> find_cracks(const Character& character,
                                                            const Surface& surface);

}  // namespace sunder::tear
