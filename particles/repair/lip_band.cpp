#include "particles/repair/lip_band.h"

#include <algorithm>
#include <cmath>

#include "particles/repair/cover.h"
#include "particles/repair/grow.h"
#include "particles/repair/lip_chains.h"
#include "particles/repair/lip_particles.h"

namespace sunder::particles {
namespace {

/// Number of points next to the lips that follow() handles; settle() does the rest.
constexpr Index kPointsAtOnce = 8;

void sort_once(std::vector<Index>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Lists the particles that the tear passes, on the lips or next to them.
std::vector<Index> particles_beside(StructureEdit& edit, std::span<const Index> lips) {
  std::vector<Index> particles;
  const PointTable& points = edit.structure().points;
  for (const Index point : lips) {
    const Ring around = edit.ring()(point);
    for (std::size_t i = 0; i < around.size(); ++i)
      for (const ParticleMembership& membership : points.memberships_of(around.point(i)))
        particles.push_back(membership.particle);
  }
  sort_once(particles);
  return particles;
}

void visit(StructureEdit& edit, const LipChain& chain, const BandPoint& at) {
  keep_to_own_side(edit, chain, at);
  join_lip_particles(edit, chain, at);
}

/// Continues the front from the lips.
void widen_front(StructureEdit& edit, Index points) {
  Structure& structure = edit.structure();
  std::unique_ptr<Band>& band = structure.tears.band;
  if (!band) return;
  RepairScratch& scratch = structure.scratch;
  scratch.band_front.run(edit.ring(), [&](Index point, float distance, Index from) {
    if (from != kNone) {
      const BesideLip beside = scratch.beside[point] = scratch.beside[from];
      const LipChain& chain = band->chains[beside.chain];
      if (distance < chain.depth) {
        visit(edit, chain, {point, chain.places[beside.place], distance});
        cover(edit, point);
      }
    }
    return --points > 0;
  });
  if (scratch.band_front.is_done() && band->to_grow.empty()) band.reset();
}

/// Sets the depth of the band of each chain. @return the greatest depth.
float set_depths(const Structure& structure, std::span<LipChain> chains) {
  const auto range = static_cast<float>(structure.report.range);
  float deepest = 0;
  for (LipChain& chain : chains) {
    chain.depth = std::min(range, std::max(0.5f * chain.length, structure.edge_length));
    deepest = std::max(deepest, chain.depth);
  }
  return deepest;
}

}  // namespace

void begin_band(StructureEdit& edit, std::span<const Index> lips) {
  Structure& structure = edit.structure();
  RepairScratch& scratch = structure.scratch;
  structure.tears.band = std::make_unique<Band>();
  Band& band = *structure.tears.band;
  band.tear = edit.tear();
  band.chains = find_lip_chains(edit.border(), structure, edit.tear(), lips);
  scratch.band_front.begin(structure.points.count(), set_depths(structure, band.chains),
                           structure.edge_length);
  Index lip_count = 0;
  for (Index c = 0; c < band.chains.size(); ++c) {
    LipChain& chain = band.chains[c];
    make_lip_particles(edit, chain);
    for (Index p = 0; p < chain.places.size(); ++p) {
      const LipChain::Place& place = chain.places[p];
      scratch.beside[place.point] = {c, p};
      scratch.band_front.add(place.point, 0.0f);
      visit(edit, chain, {place.point, place, 0.0f});
      ++lip_count;
    }
  }
  // A particle that a tear without tips divides may be in two pieces at any distance from the lips.
  const bool may_part = std::ranges::any_of(
      band.chains, [](const LipChain& chain) { return !std::isfinite(chain.length); });
  if (may_part) band.to_grow = particles_beside(edit, lips);
  cover_taken_up(edit);
  widen_front(edit, lip_count + kPointsAtOnce);
}

void begin_hole(StructureEdit& edit) {
  Structure& structure = edit.structure();
  auto band = std::make_unique<Band>();
  band->tear = edit.tear();
  for (Index point = edit.first_new_point(); point < structure.points.count(); ++point)
    if (edit.border().leaving(point) != kNone)
      for (const ParticleMembership& membership : edit.memberships(point))
        band->to_grow.push_back(membership.particle);
  if (band->to_grow.empty()) return;
  sort_once(band->to_grow);
  // A front without a source is complete at once.
  structure.scratch.band_front.begin(structure.points.count(), structure.edge_length,
                                     structure.edge_length);
  structure.tears.band = std::move(band);
}

void widen_band(StructureEdit& edit, Index points) {
  std::unique_ptr<Band>& band = edit.structure().tears.band;
  widen_front(edit, points);
  while (band && edit.structure().scratch.band_front.is_done() && !band->to_grow.empty() &&
         points > 0) {
    const Index particle = band->to_grow.back();
    band->to_grow.pop_back();
    points -= std::min(points, grow_anew(edit, particle));
    if (band->to_grow.empty()) band.reset();
  }
}

}  // namespace sunder::particles
