#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Makes particles of all points. What stands under "Of the model", and positions, are there. O(points + memberships).
/// @throws std::bad_alloc
void decompose(const TornModel& model, const DecompositionOptions& options, Structure& structure);

/// At which part of its range a particle stops to count as covering a point: a seed may stand nowhere within that of another. Less
/// than 1, so that the weights of neighbours overlap and no point is left to one particle whose share of it fades.
inline constexpr float kCovers = 0.85f;

inline constexpr std::size_t kMaximumParticles = std::size_t{1} << 20u;

}  // namespace sunder::particles
