#pragma once

#include "particles/clusters/band.h"
#include "particles/clusters/lip_border.h"
#include "particles/front/marks.h"

namespace sunder::particles {

/// Puts lips of a tear in order. Structure::lip_points says which points are on them.
/// @param points  of the chains that are wanted.
/// @param limit   metres along the border beyond the points given, after which a chain is cut off and tips are not looked for.
/// @param given, seen  scratch.
[[nodiscard]] std::vector<LipChain> find_lip_chains(const LipBorder& border, const Structure& structure, Index tear,
                                                    std::span<const Index> points, float limit, Marks& given, Marks& seen);

}  // namespace sunder::particles
