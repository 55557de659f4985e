#include "particles/repair/lip_band.h"

#include <algorithm>
#include <cmath>

#include "particles/clusters/lip_spacing.h"
#include "particles/internal/tolerances.h"
#include "particles/repair/cover.h"
#include "particles/repair/grow.h"
#include "particles/repair/lip_chains.h"
#include "particles/repair/lip_particles.h"
#include "particles/repair/row_particles.h"

namespace sunder::particles {
namespace {

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

void visit(StructureEdit& edit, std::span<const LipChain> chains, const LipChain& chain,
           const BandPoint& at) {
  keep_to_own_side(edit, chain, at);
  join_lip_particles(edit, chains, chain, at);
  fade_next_to_lip(edit, chain, at);
}

void spend(Index visited, Index& points) { points -= std::min(points, visited); }

/// Continues the front from the lips. @param points  at most; reduced by those visited.
void widen_front(StructureEdit& edit, Index& points) {
  Structure& structure = edit.structure();
  Band& band = *structure.tears.band;
  RepairScratch& scratch = structure.scratch;
  scratch.band_front.run(edit.ring(), [&](Index point, float distance, Index from) {
    if (from != kNone) {
      const BesideLip beside = scratch.beside[point] = scratch.beside[from];
      const LipChain& chain = band.chains[beside.chain];
      if (distance < chain.depth) {
        const BandPoint at = {point, chain.places[beside.place], distance};
        visit(edit, band.chains, chain, at);
        spend(cover_row(edit, chain, at), points);
        if (edit.memberships(point).empty())
          spend(cover(edit, point), points);  // at once, because it would stand still meanwhile
        else if (!is_covered(edit, point))
          band.uncovered = point;
      }
    }
    spend(1, points);
    return points > 0 && band.uncovered == kNone;
  });
}

/// Continues to grow particles. @param points  as in widen_front().
void grow(StructureEdit& edit, Index& points) {
  Structure& structure = edit.structure();
  Band& band = *structure.tears.band;
  SurfaceFront& front = structure.scratch.band_front;
  if (band.growing == kNone) {
    band.growing = band.pending.to_grow.back();
    band.pending.to_grow.pop_back();
    begin_growing(edit, band.growing);
  }
  if (!front.is_done()) {
    front.run(edit.ring(), [&](Index, float, Index) { return --points > 0; });
    return;
  }
  if (!band.is_grown) band.unreached = unreached_members(edit, band.growing);
  band.is_grown = true;
  while (points > 0 && !band.unreached.empty()) {
    spend(leave_unreached(edit, band.growing, band.unreached.back()), points);
    band.unreached.pop_back();
  }
  if (!band.unreached.empty()) return;
  band.growing = kNone;
  band.is_grown = false;
}

/// Sets the depth of the band of each chain and the spacing of its small particles.
/// @return the greatest depth.
float set_sizes(const Structure& structure, bool is_final, std::span<LipChain> chains) {
  const auto range = static_cast<float>(structure.report.range);
  const float edge = structure.character.edge_length;
  float deepest = 0;
  for (LipChain& chain : chains) {
    chain.depth = band_depth(range, edge, chain.length);
    deepest = std::max(deepest, chain.depth);
    const float spacing = lip_spacing(range, edge, chain.length);
    chain.spacing = is_final && spacing <= kMostSpacingRanges * range ? spacing : 0;
  }
  return deepest;
}

/// Adds particles to be regrown.
void add_to_grow(PendingWork& pending, std::span<const Index> particles) {
  pending.to_grow.insert(pending.to_grow.end(), particles.begin(), particles.end());
  sort_once(pending.to_grow);
}

void add_lips(PendingWork& pending, Index tear, std::span<const Index> points) {
  if (points.empty()) return;
  if (pending.lips.empty() || pending.lips.back().tear != tear) pending.lips.push_back({tear, {}});
  std::vector<Index>& known = pending.lips.back().points;
  known.insert(known.end(), points.begin(), points.end());
}

/// Finds the chains of the band and begins the front from them.
/// @return the number of points on the chains.
Index begin_front(StructureEdit& edit) {
  Structure& structure = edit.structure();
  RepairScratch& scratch = structure.scratch;
  Band& band = *structure.tears.band;
  band.is_begun = true;
  band.uncovered = kNone;
  band.met_count = 0;
  std::erase_if(band.lips,
                [&](Index point) { return edit.surface().point_corner[point] == kNone; });
  band.chains = find_lip_chains(edit.border(), structure, edit.tear(), band.lips);
  band.is_final |= structure.tears.done[edit.tear()].operation != 0;
  const float depth =
      std::max(set_sizes(structure, band.is_final, band.chains), structure.character.edge_length);
  scratch.band_front.begin(structure.points.count(), depth, structure.character.edge_length);
  Index lip_count = 0;
  for (LipChain& chain : band.chains) make_lip_particles(edit, chain);
  for (Index c = 0; c < band.chains.size(); ++c) {
    const LipChain& chain = band.chains[c];
    for (Index p = 0; p < chain.places.size(); ++p) {
      const LipChain::Place& place = chain.places[p];
      scratch.beside[place.point] = {c, p};
      scratch.band_front.add(place.point, 0.0f);
      visit(edit, band.chains, chain, {place.point, place, 0.0f});
      ++lip_count;
    }
  }
  // A particle that a tear without tips divides may be in two pieces at any distance from the lips.
  const bool may_part = std::ranges::any_of(
      band.chains, [](const LipChain& chain) { return !std::isfinite(chain.length); });
  if (may_part) add_to_grow(band.pending, particles_beside(edit, band.lips));
  cover_taken_up(edit);
  return lip_count;
}

/// The work that a band and what follows it leave.
PendingWork work_of(const Band& band, const Structure& structure) {
  PendingWork work = band.pending;
  if (band.growing != kNone)
    add_to_grow(work, {&band.growing, 1});
  else if (!band.is_begun || !structure.scratch.band_front.is_done() || band.uncovered != kNone)
    add_lips(work, band.tear, band.lips);
  return work;
}

/// Continues with the lips that an earlier call left, if there are any. Their band is begun by an
/// edit of their tear.
void take_pending_lips(const Structure& structure, Band& band) {
  band.is_begun = band.is_final = false;
  band.lips.clear();
  if (band.pending.lips.empty()) return;
  PendingLips next = std::move(band.pending.lips.back());
  band.pending.lips.pop_back();
  band.tear = next.tear;
  band.lips = std::move(next.points);
  sort_once(band.lips);
  std::erase_if(band.lips, [&](Index point) {
    return point >= structure.points.count() ||
           structure.points.lip_points[point].tear != band.tear;
  });
}

/// A new band, after which the work that is left goes on. A stroke that goes on begins its next
/// band before the last one is complete, because the new one would visit the same points again.
Band& renew_band(Structure& structure, Index tear) {
  auto band = std::make_unique<Band>();
  band->tear = tear;
  if (structure.tears.band) band->pending = work_of(*structure.tears.band, structure);
  structure.tears.band = std::move(band);
  return *structure.tears.band;
}

[[nodiscard]] bool is_complete(const Structure& structure) {
  const Band& band = *structure.tears.band;
  return band.is_begun && structure.scratch.band_front.is_done() && band.uncovered == kNone &&
         band.growing == kNone && band.pending.empty();
}

}  // namespace

std::shared_ptr<const PendingWork> pending_work(const Structure& structure) {
  if (!structure.tears.band) return structure.tears.waiting;
  return std::make_shared<PendingWork>(work_of(*structure.tears.band, structure));
}

void resume_work(Structure& structure, const std::shared_ptr<const PendingWork>& work, bool waits) {
  TearLog& tears = structure.tears;
  tears.band.reset();
  tears.waiting.reset();
  if (!work || work->empty()) return;
  if (waits) {
    tears.waiting = work;
    return;
  }
  tears.band = std::make_unique<Band>();
  tears.band->pending = *work;
  take_pending_lips(structure, *tears.band);
}

void begin_band(StructureEdit& edit, std::span<const Index> lips, bool is_final) {
  Structure& structure = edit.structure();
  Band& band = renew_band(structure, edit.tear());
  band.lips.assign(lips.begin(), lips.end());
  band.is_final = is_final;
  if (is_final)  // whose lips are all of the tear
    std::erase_if(band.pending.lips,
                  [&](const PendingLips& pending) { return pending.tear == edit.tear(); });
  (void)begin_front(edit);
  if (is_complete(structure)) structure.tears.band.reset();
}

void begin_hole(StructureEdit& edit) {
  Structure& structure = edit.structure();
  Band& band = renew_band(structure, edit.tear());
  std::vector<Index> particles;
  for (Index point = edit.first_new_point(); point < structure.points.count(); ++point)
    if (edit.border().leaving(point) != kNone)
      for (const ParticleMembership& membership : edit.memberships(point))
        particles.push_back(membership.particle);
  add_to_grow(band.pending, particles);
  if (band.pending.empty()) structure.tears.band.reset();
}

Index widen_band(StructureEdit& edit, Index points) {
  Structure& structure = edit.structure();
  std::unique_ptr<Band>& band = structure.tears.band;
  while (points > 0 && band->tear == edit.tear()) {
    if (!band->is_begun)
      points -= std::min(points, begin_front(edit));
    else if (band->uncovered != kNone)
      go_on_covering(edit, points);
    else if (band->growing != kNone)
      grow(edit, points);
    else if (!structure.scratch.band_front.is_done())
      widen_front(edit, points);
    else if (!band->pending.lips.empty())
      take_pending_lips(structure, *band);
    else if (!band->pending.to_grow.empty())
      grow(edit, points);
    if (!is_complete(structure)) continue;
    band.reset();
    break;
  }
  return points;
}

}  // namespace sunder::particles
