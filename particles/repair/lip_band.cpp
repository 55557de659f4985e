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

/// Continues the front from the lips. @param points  at most; reduced by those visited.
void widen_front(StructureEdit& edit, Index& points) {
  Structure& structure = edit.structure();
  const Band& band = *structure.tears.band;
  RepairScratch& scratch = structure.scratch;
  scratch.band_front.run(edit.ring(), [&](Index point, float distance, Index from) {
    if (from != kNone) {
      const BesideLip beside = scratch.beside[point] = scratch.beside[from];
      const LipChain& chain = band.chains[beside.chain];
      if (distance < chain.depth) {
        visit(edit, chain, {point, chain.places[beside.place], distance});
        cover(edit, point);
      }
    }
    return --points > 0;
  });
}

/// Continues to grow particles. @param points  as in widen_front().
void grow(StructureEdit& edit, Index& points) {
  Structure& structure = edit.structure();
  Band& band = *structure.tears.band;
  SurfaceFront& front = structure.scratch.band_front;
  if (band.growing == kNone) {
    band.growing = band.to_grow.back();
    band.to_grow.pop_back();
    begin_growing(edit, band.growing);
  }
  front.run(edit.ring(), [&](Index, float, Index) { return --points > 0; });
  if (!front.is_done()) return;
  points -= std::min(points, finish_growing(edit, band.growing));
  band.growing = kNone;
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

/// Begins the front from some lips. @return the number of points on their chains.
Index begin_front(StructureEdit& edit, std::span<const Index> lips) {
  Structure& structure = edit.structure();
  RepairScratch& scratch = structure.scratch;
  Band& band = *structure.tears.band;
  band.lips.assign(lips.begin(), lips.end());
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
  if (may_part) {
    const std::vector<Index> beside = particles_beside(edit, lips);
    band.to_grow.insert(band.to_grow.end(), beside.begin(), beside.end());
    sort_once(band.to_grow);
  }
  return lip_count;
}

/// Begins the front from the lips that earlier calls of the stroke left.
/// @return as begin_front().
Index begin_pending(StructureEdit& edit) {
  const Structure& structure = edit.structure();
  std::vector<Index> lips = std::move(structure.tears.band->pending);
  structure.tears.band->pending.clear();
  sort_once(lips);
  std::erase_if(lips, [&](Index point) {
    return edit.surface().point_corner[point] == kNone ||
           structure.points.lip_points[point].tear != edit.tear();
  });
  const Index lip_count = begin_front(edit, lips);
  cover_taken_up(edit);
  return lip_count;
}

/// A new band of a tear. Where the stroke goes on before the last one is complete, that one is left
/// for later: the new one covers its end, and would visit the same points again.
Band& renew_band(Structure& structure, Index tear) {
  auto band = std::make_unique<Band>();
  band->tear = tear;
  if (std::unique_ptr<Band>& last = structure.tears.band; last && last->tear == tear) {
    band->pending = std::move(last->pending);
    if (last->growing != kNone)
      last->to_grow.push_back(last->growing);
    else if (!structure.scratch.band_front.is_done())
      band->pending.insert(band->pending.end(), last->lips.begin(), last->lips.end());
    band->to_grow = std::move(last->to_grow);
    sort_once(band->to_grow);
  }
  structure.tears.band = std::move(band);
  return *structure.tears.band;
}

[[nodiscard]] bool is_complete(const Structure& structure) {
  const Band& band = *structure.tears.band;
  return structure.scratch.band_front.is_done() && band.pending.empty() && band.to_grow.empty() &&
         band.growing == kNone;
}

}  // namespace

void begin_band(StructureEdit& edit, std::span<const Index> lips) {
  Structure& structure = edit.structure();
  (void)renew_band(structure, edit.tear());
  Index points = begin_front(edit, lips) + kPointsAtOnce;
  cover_taken_up(edit);
  widen_front(edit, points);
  if (is_complete(structure)) structure.tears.band.reset();
}

void begin_hole(StructureEdit& edit) {
  Structure& structure = edit.structure();
  Band& band = renew_band(structure, edit.tear());
  for (Index point = edit.first_new_point(); point < structure.points.count(); ++point)
    if (edit.border().leaving(point) != kNone)
      for (const ParticleMembership& membership : edit.memberships(point))
        band.to_grow.push_back(membership.particle);
  sort_once(band.to_grow);
  // A front without a source is complete at once.
  structure.scratch.band_front.begin(structure.points.count(), structure.edge_length,
                                     structure.edge_length);
  Index points = 1;
  widen_front(edit, points);
  if (is_complete(structure)) structure.tears.band.reset();
}

void widen_band(StructureEdit& edit, Index points) {
  Structure& structure = edit.structure();
  std::unique_ptr<Band>& band = structure.tears.band;
  while (band && points > 0) {
    if (band->growing != kNone)
      grow(edit, points);
    else if (!structure.scratch.band_front.is_done())
      widen_front(edit, points);
    else if (!band->pending.empty())
      points -= std::min(points, begin_pending(edit));
    else if (!band->to_grow.empty())
      grow(edit, points);
    if (is_complete(structure)) band.reset();
  }
}

}  // namespace sunder::particles
