#pragma once

#include <sunder/particles/material.h>
#include <sunder/particles/particle_set.h>

#include <span>
#include <vector>

namespace sunder::particles {

/// A spring from a particle to a neighbour. Both have it, with the same numbers, so that their forces are opposite.
struct Spring {
  Index other = 0;
  double stiffness = 0;  ///< Newtons a metre.
  double damping = 0;    ///< Newton seconds a metre.
  double frequency = 0;  ///< Root of the stiffness by mass and coupling; radians a second.
  double stretch_limit = 0;
};

/// The springs of all particles, each from both ends.
struct SpringGraph {
  std::vector<Index> first = {0};  ///< Of each particle; at the end their number.
  std::vector<Spring> springs;

  [[nodiscard]] std::span<const Spring> of(Index particle) const {
    return {springs.data() + first[particle], first[particle + 1] - first[particle]};
  }
};

/// Materials that differ meet half-way: stiffness, ratio and mass of their spring are the means, its stretch limit the lesser.
/// @param material_of  one a particle. O(pairs of neighbours).
void connect(const ParticleSet& set, std::span<const SoftMaterial> materials, std::span<const Index> material_of,
             SpringGraph& graph);

/// The spring of two materials, before its other end is known.
[[nodiscard]] Spring spring_between(const SoftMaterial& a, const SoftMaterial& b, double coupling);

}  // namespace sunder::particles
