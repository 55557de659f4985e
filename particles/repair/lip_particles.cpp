#include "particles/repair/lip_particles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/internal/ordered.h"
#include "particles/clusters/band.h"
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

void make_particle(StructureEdit& edit, LipChain& chain, const LipChain::Place& place,
                   float half_width, bool is_small) {
  const Index particle =
      edit.make_particle(place.point, half_width, influences_from(edit.memberships(place.point)));
  edit.structure().particles[particle].sides.push_back({edit.tear(), chain.side});
  chain.particles.push_back({particle, place.along, half_width, is_small});
}

/// Lists the particles that a band made for the lip which was not completed: this one goes on to
/// give them members. Large ones that a stroke in progress makes, which small ones replace when it
/// ends, are left as they are.
void take_up_particles(const StructureEdit& edit, LipChain& chain) {
  const Structure& structure = edit.structure();
  const auto range = static_cast<float>(structure.report.range);
  const Index first_of_tear = structure.tears.done[edit.tear()].particles;
  const bool is_final = structure.tears.band->is_final;
  for (const LipChain::Place& place : chain.places)
    for (const ParticleMembership& membership : edit.memberships(place.point)) {
      const Particle& particle = structure.particles[membership.particle];
      if (particle.seed != place.point || membership.particle < first_of_tear) continue;
      const bool is_small = is_small_of_lip(structure, membership.particle, edit.tear(), chain);
      const Side* side = particle.side_of(edit.tear());
      const bool is_large =
          is_final && side != nullptr && *side == chain.side && !(chain.fineness(place, range) > 0);
      if (is_small || is_large)
        chain.particles.push_back({membership.particle, place.along, particle.range, is_small});
    }
}

/// Makes a small particle at the point nearest to a place along the chain.
void make_small(StructureEdit& edit, LipChain& chain, float along) {
  auto place = std::ranges::lower_bound(chain.places, along, {}, &LipChain::Place::along);
  if (place == chain.places.end() ||
      (place != chain.places.begin() && along - (place - 1)->along < place->along - along))
    --place;
  const auto range = static_cast<float>(edit.structure().report.range);
  const auto is_near = [&](const LipChain::OfLip& of) {
    return of.is_small && std::abs(place->along - of.along) < 0.6f * chain.spacing;
  };
  if (std::abs(place->along - along) <= chain.spacing && chain.fineness(*place, range) > 0 &&
      std::ranges::none_of(chain.particles, is_near))
    make_particle(edit, chain, *place, kLipRangeSpacings * chain.spacing, true);
}

/// The small particles of both lips of a gap face one another: they divide it from tip to tip, or
/// begin at the only tip that is near.
void make_small_particles(StructureEdit& edit, LipChain& chain) {
  const float end = chain.places.back().along;
  const auto most = kNearTipRanges * static_cast<float>(edit.structure().report.range);
  const float last = std::isfinite(chain.length) ? 0.5f * chain.length : most;
  for (const bool is_front : {true, false}) {
    const LipChain::End& from = is_front ? chain.front : chain.back;
    if (!std::isfinite(from.distance)) continue;
    for (float to_tip = 0.5f * chain.spacing; to_tip <= last; to_tip += chain.spacing)
      make_small(edit, chain, is_front ? to_tip - from.distance : end + from.distance - to_tip);
    // One more between the first and the tip, where the gap closes.
    const LipChain::Place& nearest = is_front ? chain.places.front() : chain.places.back();
    const auto is_there = [&](const LipChain::OfLip& of) {
      return of.is_small && edit.structure().particles[of.particle].seed == nearest.point;
    };
    if (from.tip != kNone && from.distance < 0.25f * chain.spacing &&
        std::ranges::none_of(chain.particles, is_there))
      make_particle(edit, chain, nearest, kTipRangeSpacings * chain.spacing, true);
  }
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

void join(StructureEdit& edit, Index point, Index particle, float reach) {
  if (reach < 1 && edit.may_join(point, particle)) edit.join(point, {particle, reach});
}

}  // namespace

bool is_small_of_lip(const Structure& structure, Index particle, Index tear,
                     const LipChain& chain) {
  if (particle < structure.tears.done[tear].particles) return false;
  const auto& [seed, range] =
      std::tie(structure.particles[particle].seed, structure.particles[particle].range);
  const bool has_size = std::abs(range - kLipRangeSpacings * chain.spacing) < 1e-3f * range ||
                        std::abs(range - kTipRangeSpacings * chain.spacing) < 1e-3f * range;
  return has_size && (structure.points.is_on_lip(seed, tear, Side::left) ||
                      structure.points.is_on_lip(seed, tear, Side::right));
}

void make_lip_particles(StructureEdit& edit, LipChain& chain) {
  take_up_particles(edit, chain);
  if (chain.spacing > 0) make_small_particles(edit, chain);
  const auto range = static_cast<float>(edit.structure().report.range);
  const bool is_short = chain.depth < 0.5f * range;
  const float half_width =
      std::isfinite(chain.length)
          ? std::min(range, std::max(0.55f * chain.length, edit.structure().character.edge_length))
          : range;
  const float end = chain.places.back().along;
  for (std::size_t i = 0; i < chain.places.size(); ++i) {
    if (is_covered(edit, chain, chain.places[i], is_short)) continue;
    const float wanted =
        std::min(chain.places[i].along + 0.6f * half_width, 0.5f * (chain.places[i].along + end));
    std::size_t at = i;
    while (at + 1 < chain.places.size() && chain.places[at].along < wanted) ++at;
    make_particle(edit, chain, chain.places[at], half_width, false);
  }
}

void join_lip_particles(StructureEdit& edit, std::span<const LipChain> chains,
                        const LipChain& chain, const BandPoint& at) {
  const std::vector<Vec3f>& positions = edit.structure().points.positions;
  const LipChain::End* const tip =
      at.place.point == chain.places.front().point && chain.front.tip != kNone ? &chain.front
      : at.place.point == chain.places.back().point && chain.back.tip != kNone ? &chain.back
                                                                               : nullptr;
  const auto between = [&](Index a, Index b) { return norm(Vec3f(positions[b] - positions[a])); };
  const auto seed_of = [&](const LipChain::OfLip& of) {
    return edit.structure().particles[of.particle].seed;
  };
  for (const LipChain::OfLip& of : chain.particles) {
    const float along = at.place.along - of.along;
    if (!of.is_small)
      join(edit, at.point, of.particle,
           length_of(at.distance / chain.depth, along / of.half_width));
    else if (std::abs(along) < of.half_width)
      // Beyond the end of the chain the point is not abreast of its place.
      join(edit, at.point, of.particle,
           (tip != nullptr ? between(at.point, seed_of(of)) : length_of(at.distance, along)) /
               of.half_width);
  }
  if (tip == nullptr || tip->other == kNone) return;
  const float to_tip = between(at.point, tip->tip);
  for (const LipChain::OfLip& of : chains[tip->other].particles)
    if (of.is_small)
      join(edit, at.point, of.particle, (to_tip + between(tip->tip, seed_of(of))) / of.half_width);
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
