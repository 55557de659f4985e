#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Divides all points into particles. The structure already has its character, vertices and
/// positions. O(points + memberships).
/// @throws std::bad_alloc, and std::length_error for more than kMaximumParticles.
void decompose(const TornModel& model, const DecompositionOptions& options, Structure& structure);

inline constexpr std::size_t kMaximumParticles = std::size_t{1} << 20u;

}  // namespace sunder::particles
