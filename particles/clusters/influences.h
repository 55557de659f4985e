#pragma once

#include <sunder/particles/particle_set.h>

namespace sunder::particles {

/// The share of a particle in a point, before the shares of the point are normalised: (1 -
/// reach^2)^2, which ends with slope zero.
[[nodiscard]] inline float falloff(float reach) {
  const float rest = 1 - reach * reach;
  return rest * rest;
}

/// Influences from memberships: the four largest shares, each minus the fifth, so that weights are
/// continuous where another particle becomes the fourth.
[[nodiscard]] ParticleInfluences influences_from(std::span<const ParticleMembership> memberships);

/// Calls visit(particle, weight) for each particle that moves a point.
template <class Visit>
void for_each_influence(const ParticleInfluences& of, Visit visit) {
  for (std::size_t k = 0; k < 4 && of.weights[k] > 0; ++k)
    visit(of.particles[k], double{of.weights[k]});
}

}  // namespace sunder::particles
