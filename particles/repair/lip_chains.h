#pragma once

#include "particles/clusters/band.h"
#include "particles/clusters/lip_border.h"
#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Puts the lips of a tear in order. A chain ends a range of particles beyond the points given, and
/// tips are looked for as far.
/// @param structure  says which points are on lips; its scratch memory is used.
/// @param points     of the chains that are wanted.
[[nodiscard]] std::vector<LipChain> find_lip_chains(const LipBorder& border, Structure& structure,
                                                    Index tear, std::span<const Index> points);

}  // namespace sunder::particles
