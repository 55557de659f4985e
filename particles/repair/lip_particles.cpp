#include "particles/repair/lip_particles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "particles/clusters/influences.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

float length_of(float x, float y) { return std::sqrt(x * x + y * y); }

float smoothstep(float x) {
  x = std::clamp(x, 0.0f, 1.0f);
  return x * x * (3 - 2 * x);
}

/// Whether a particle that stayed on the lip, or one of its own, is near enough to one of its
/// places.
/// @param is_short  whether the tear is so short that the particles from before it are too large
///         for it.
bool is_covered(const StructureEdit& edit, const LipChain& chain, const LipChain::Place& place,
                bool is_short) {
  // The band of a tear may be continued by a later operation.
  const Index first_of_tear = edit.structure().tears.done[edit.tear()].particles;
  for (const LipChain::OfLip& of : chain.particles)
    if (std::abs(place.along - of.along) < kLipCoveredReach * of.half_width) return true;
  for (const ParticleMembership& membership : edit.memberships(place.point)) {
    if (!(membership.reach < kLipCoveredReach)) continue;
    const Side* side = edit.structure().particles[membership.particle].side_of(edit.tear());
    if (side != nullptr && *side != chain.side) continue;
    if (!is_short || membership.particle >= first_of_tear) return true;
  }
  return false;
}

/// The reach of a particle of the other lip at a point, along the current surface.
float reach_around_tip(const ParticleMembership& membership, float range, const LipChain& chain,
                       const BandPoint& at) {
  const float to_tip = at.place.to_tip, straight = membership.reach * range;
  float around = std::numeric_limits<float>::infinity();
  if (to_tip < 2 * range)
    around =
        length_of(to_tip, at.distance) + length_of(to_tip, std::max(0.0f, straight - at.distance));
  // If the band ends before the particle, weights must still be continuous.
  if (chain.depth < range)
    around = std::min(around, 2 * range) +
             (straight - std::min(around, 2 * range)) * smoothstep(at.distance / chain.depth);
  return std::max(
      {membership.reach, around / range, 1 - at.distance / std::min(chain.depth, to_tip)});
}

}  // namespace

void make_lip_particles(StructureEdit& edit, LipChain& chain) {
  Structure& structure = edit.structure();
  const auto range = static_cast<float>(structure.report.range);
  const bool is_short = chain.depth < 0.5f * range;
  const float half_width =
      std::isfinite(chain.length)
          ? std::min(range, std::max(0.55f * chain.length, structure.character.edge_length))
          : range;
  const float end = chain.places.back().along;
  for (std::size_t i = 0; i < chain.places.size(); ++i) {
    if (is_covered(edit, chain, chain.places[i], is_short)) continue;
    const float wanted =
        std::min(chain.places[i].along + 0.6f * half_width, 0.5f * (chain.places[i].along + end));
    std::size_t at = i;
    while (at + 1 < chain.places.size() && chain.places[at].along < wanted) ++at;
    const Index seed = chain.places[at].point;
    const Index particle =
        edit.make_particle(seed, half_width, influences_from(edit.memberships(seed)));
    structure.particles[particle].sides.push_back({edit.tear(), chain.side});
    chain.particles.push_back({particle, chain.places[at].along, half_width});
  }
}

void join_lip_particles(StructureEdit& edit, const LipChain& chain, const BandPoint& at) {
  for (const LipChain::OfLip& of : chain.particles) {
    const float reach =
        length_of(at.distance / chain.depth, (at.place.along - of.along) / of.half_width);
    if (reach < 1 && edit.may_join(at.point, of.particle))
      edit.join(at.point, {of.particle, reach});
  }
}

void keep_to_own_side(StructureEdit& edit, const LipChain& chain, const BandPoint& at) {
  const std::vector<Particle>& particles = edit.structure().particles;
  const auto is_of_other_side = [&](const ParticleMembership& membership) {
    const Side* side = particles[membership.particle].side_of(edit.tear());
    return side != nullptr && *side != chain.side;
  };
  if (std::ranges::none_of(edit.memberships(at.point), is_of_other_side)) return;
  edit.keep_if(at.point, [&](ParticleMembership& membership) {
    if (!is_of_other_side(membership)) return true;
    if (!(at.distance > 0)) return false;
    membership.reach =
        reach_around_tip(membership, particles[membership.particle].range, chain, at);
    return membership.reach < 1;
  });
}

}  // namespace sunder::particles
