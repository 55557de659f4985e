#pragma once

#include "particles/rupture/tissue.h"

namespace sunder::particles {

/// A tip of a tear, and the energy that the tissue would release per length if the tear ran on.
struct TipLoad {
  Index tip = 0;
  Index left = 0, right = 0;  ///< The particles of the first lip points next to it.
  double radius = 0;          ///< Of the disc around the tip whose displacements count, metres.
  double release = 0;         ///< Newtons, that is joules per metre.
};

/// The loads of those tips at which one of the two particles is awake.
///
/// Next to a tip a membrane of stiffness S moves by a sqrt(r) sin(theta / 2) in polar coordinates,
/// and running on releases pi S |a|^2 / 4 per length (Griffith 1921, Irwin 1957), where the part of
/// the vector a that would push the lips into one another does not count. The reciprocal
/// theorem gives a from the displacements and the loads within some spacings of the small
/// particles; see docs/method/particles.md.
///
/// @param tips  ParticleSet::tips(). O(points of lips near tips + faces along the lines of
/// TipDisc),
///              allocates.
[[nodiscard]] std::vector<TipLoad> tip_loads(const Tissue& tissue, std::span<const Index> tips);

}  // namespace sunder::particles
