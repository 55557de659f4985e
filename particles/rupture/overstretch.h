#pragma once

#include <vector>

#include "particles/rupture/tissue.h"

namespace sunder::particles {

/// A particle around which the tissue is stretched beyond its strength.
struct Overstretched {
  Index particle = 0;
  double over = 0;  ///< Stretch over strength.
};

/// The greatest principal stretch of the tissue around a particle, by its displacements: of the
/// linear map that fits best how its neighbours' seeds moved from its own. It is exact where strain
/// is even, and converges to the stretch of the surface with smaller ranges. Tissue whose plane
/// faces backwards counts as pressed through itself, not as turned over. O(neighbours).
[[nodiscard]] double stretch_around(const Tissue& tissue, Index particle);

/// Awake particles beyond the strength of their material, the worst first. O(particles + awake
/// particles x neighbours), allocates.
/// @param greatest  raised to the greatest stretch around an awake particle whose material has a
///                  strength.
[[nodiscard]] std::vector<Overstretched> find_overstretched(const Tissue& tissue, double& greatest);

}  // namespace sunder::particles
