#include "particles/clusters/influences.h"

#include <bit>

namespace sunder::particles {

ParticleInfluences influences_from(std::span<const ParticleMembership> memberships) {
  // The five largest shares, descending; among equal ones the lower particle first. The bits of a
  // share and, below them, those of the particle form one number to sort by, without unpredictable
  // branches.
  std::uint64_t first = 0, second = 0, third = 0, fourth = 0, fifth = 0;
  for (const ParticleMembership& membership : memberships) {
    std::uint64_t key = std::uint64_t{std::bit_cast<std::uint32_t>(falloff(membership.reach))}
                            << 32u |
                        ~membership.particle;
    if (key <= fifth) continue;  // of many memberships most
    for (std::uint64_t* const of : {&first, &second, &third, &fourth, &fifth}) {
      const std::uint64_t change =
          (*of ^ key) & (std::uint64_t{0} - static_cast<std::uint64_t>(key > *of));
      *of ^= change;
      key ^= change;
    }
  }
  const auto share_of = [](std::uint64_t key) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32u));
  };
  const std::array<float, 5> shares = {share_of(first), share_of(second), share_of(third),
                                       share_of(fourth), share_of(fifth)};
  const std::array<Index, 4> particles = {~static_cast<Index>(first), ~static_cast<Index>(second),
                                          ~static_cast<Index>(third), ~static_cast<Index>(fourth)};
  ParticleInfluences influences;
  // With five equal shares nothing would be left.
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
