#pragma once

#include <vector>

#include "particles/rupture/tissue.h"

namespace sunder::particles {

/// A particle around which the tissue is stretched beyond its strength.
struct Overstretched {
  Index particle = 0;
  double over = 0;     ///< Stretch over strength.
  Course course = {};  ///< Along a perforation, if that is what gives way.
};

/// The greatest principal stretch of the tissue around a particle, by its displacements: of the
/// linear map that fits best how its neighbours' seeds moved from its own. It is exact where strain
/// is even, and converges to the stretch of the surface with smaller ranges. Tissue whose plane
/// faces backwards counts as pressed through itself, not as turned over. O(neighbours).
[[nodiscard]] double stretch_around(const Tissue& tissue, Index particle);

/// Awake particles beyond the strength of their material, or of a perforation next to them, the
/// worst first. O(particles + awake
/// particles x neighbours), allocates.
/// @param length  of a tear along a perforation, metres.
/// @param greatest  raised to the greatest stretch around an awake particle whose material has a
///                  strength.
[[nodiscard]] std::vector<Overstretched> find_overstretched(const Tissue& tissue, double length,
                                                            double& greatest);

}  // namespace sunder::particles
