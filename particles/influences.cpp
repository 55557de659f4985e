#include <bit>

#include "particles/structure.h"

namespace sunder::particles {

ParticleInfluences influences_from(std::span<const Membership> memberships) {
  // The five largest shares, descending; of equal ones the lower particle first. A share's bits and, below them, a particle's are
  // one number to sort by, without branches that could not be guessed.
  std::array<std::uint64_t, 5> largest = {};
  for (const Membership& membership : memberships) {
    std::uint64_t key = std::uint64_t{std::bit_cast<std::uint32_t>(falloff(membership.reach))} << 32u | ~membership.particle;
    for (std::uint64_t& of : largest) {
      const std::uint64_t larger = std::max(of, key);
      key = std::min(of, key);
      of = larger;
    }
  }
  std::array<float, 5> shares;
  for (std::size_t i = 0; i < 5; ++i) shares[i] = std::bit_cast<float>(static_cast<std::uint32_t>(largest[i] >> 32u));
  ParticleInfluences influences;
  // Five that are equally near leave nothing to subtract from.
  const float less = shares[0] > shares[4] ? shares[4] : 0.0f;
  float sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += shares[i] - less;
  if (!(sum > 0)) return influences;
  for (std::size_t i = 0; i < 4; ++i) {
    influences.weights[i] = (shares[i] - less) / sum;
    influences.particles[i] = influences.weights[i] > 0 ? ~static_cast<Index>(largest[i]) : 0;
  }
  return influences;
}

}  // namespace sunder::particles
