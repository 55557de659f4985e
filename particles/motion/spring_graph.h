#pragma once

#include <sunder/particles/material.h>
#include <sunder/particles/particle_set.h>

#include <span>
#include <vector>

namespace sunder::particles {

/// A spring from a particle to a neighbour. Both ends store it, with the same numbers, so that
/// their forces are opposite.
struct Spring {
  Index other = 0;
  double stiffness = 0;  ///< Newtons per metre.
  double damping = 0;    ///< Newton seconds per metre.
  double frequency = 0;  ///< Root of stiffness / mass, and coupling; radians per second.
  double stretch_limit = 0;
};

/// The springs of all particles, each from both ends.
struct SpringGraph {
  std::vector<Index> first = {0};  ///< Per particle its first spring; the total at the end.
  std::vector<Spring> springs;
  bool is_stale = true;  ///< Whether particles or materials changed since connect().

  [[nodiscard]] std::span<const Spring> of(Index particle) const {
    return {springs.data() + first[particle], first[particle + 1] - first[particle]};
  }
};

/// Connects all neighbours. If their materials differ, the spring has the means of stiffness, ratio
/// and mass, and the smaller stretch limit.
/// @param material_of  per particle. O(pairs of neighbours). @throws std::bad_alloc
void connect(const ParticleSet& set, std::span<const SoftMaterial> materials,
             std::span<const Index> material_of, SpringGraph& graph);

/// The spring of two materials, before its other end is known.
[[nodiscard]] Spring spring_between(const SoftMaterial& a, const SoftMaterial& b, double coupling);

}  // namespace sunder::particles
