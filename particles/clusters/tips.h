#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Points where the two lips of a tear meet, ascending. O(edges of lips), allocates.
[[nodiscard]] std::vector<Index> find_tips(const TornModel& model, const Structure& structure);

}  // namespace sunder::particles
