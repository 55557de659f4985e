#pragma once

#include "particles/clusters/band.h"
#include "particles/clusters/lip_border.h"
#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Orders the lips of a tear into chains. A chain ends a range of particles beyond the given
/// points, and tips are searched equally far.
/// @param structure  tells which points are on lips; its scratch memory is used.
/// @param points     points of the requested chains.
[[nodiscard]] std::vector<LipChain> find_lip_chains(const LipBorder& border, Structure& structure,
                                                    Index tear, std::span<const Index> points);

}  // namespace sunder::particles
