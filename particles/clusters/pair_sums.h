#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Computes the neighbours and the weight of every particle from the influences of all points.
/// O(points), expected.
void sum_pairs(Structure& structure);

}  // namespace sunder::particles
