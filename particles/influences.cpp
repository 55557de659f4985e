#include "particles/structure.h"

namespace sunder::particles {

ParticleInfluences influences_from(std::span<const Membership> memberships) {
  // The five largest shares, descending; of equal ones the lower particle first.
  std::array<float, 5> shares = {};
  std::array<Index, 5> particles = {};
  for (const Membership& membership : memberships) {
    const float share = falloff(membership.reach);
    if (!(share > shares[4])) continue;
    std::size_t at = 4;
    for (; at > 0 && share > shares[at - 1]; --at) {
      shares[at] = shares[at - 1];
      particles[at] = particles[at - 1];
    }
    shares[at] = share;
    particles[at] = membership.particle;
  }
  ParticleInfluences influences;
  // Five that are equally near leave nothing to subtract from.
  const float less = shares[0] > shares[4] ? shares[4] : 0.0f;
  float sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += shares[i] - less;
  if (!(sum > 0)) return influences;
  for (std::size_t i = 0; i < 4; ++i) {
    influences.weights[i] = (shares[i] - less) / sum;
    influences.particles[i] = influences.weights[i] > 0 ? particles[i] : 0;
  }
  return influences;
}

}  // namespace sunder::particles
