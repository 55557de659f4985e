#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Makes every particle's list of neighbours, and its weight, from the influences of all points. O(points), expected.
void sum_pairs(Structure& structure);

}  // namespace sunder::particles
