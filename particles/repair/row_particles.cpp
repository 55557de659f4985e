#include "particles/repair/row_particles.h"

#include <algorithm>

#include "particles/clusters/influences.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

/// The least reach of other particles at a point between the row and the lip; 0 from the row on.
float least_reach(const LipChain& chain, float distance, float fineness) {
  return fineness * (1 - distance / (kRowDistanceSpacings * chain.spacing));
}

float fineness_of(const StructureEdit& edit, const LipChain& chain, const BandPoint& at) {
  return chain.fineness(at.place, static_cast<float>(edit.structure().report.range));
}

}  // namespace

void fade_next_to_lip(StructureEdit& edit, const LipChain& chain, const BandPoint& at) {
  float least = least_reach(chain, at.distance, fineness_of(edit, chain, at));
  if (!(least > 0)) return;
  const Structure& structure = edit.structure();
  float nearest = 1;
  for (const ParticleMembership& membership : edit.memberships(at.point))
    if (is_small_of_lip(structure, membership.particle, edit.tear(), chain))
      nearest = std::min(nearest, membership.reach);
  // Where the lip's own particles end too, the others are needed.
  least *= std::min(1.0f, 4 * (1 - nearest));
  if (!(least > 0)) return;
  edit.keep_if(at.point, [&](ParticleMembership& membership) {
    if (!is_small_of_lip(structure, membership.particle, edit.tear(), chain))
      membership.reach = std::max(membership.reach, least);
    return membership.reach < 1;
  });
}

Index cover_row(StructureEdit& edit, const LipChain& chain, const BandPoint& at) {
  const float spacing = kRowSpacings * chain.spacing,
              nearest = kRowDistanceSpacings * chain.spacing;
  const float fineness = fineness_of(edit, chain, at);
  if (at.distance < nearest || at.distance > nearest + spacing || fineness < 0.5f) return 0;
  Structure& structure = edit.structure();
  const auto is_on_lip = [&](Index point) {
    return structure.points.is_on_lip(point, edit.tear(), Side::left) ||
           structure.points.is_on_lip(point, edit.tear(), Side::right);
  };
  if (is_on_lip(at.point)) return 0;  // of another chain
  const float range = kLipRangeSpacings * spacing;
  const auto is_of_row = [&](const ParticleMembership& membership) {
    const float of = structure.particles[membership.particle].range;
    return of <= 1.5f * range && membership.reach * of < spacing &&
           !is_small_of_lip(structure, membership.particle, edit.tear(), chain);
  };
  if (std::ranges::any_of(edit.memberships(at.point), is_of_row)) return 0;
  const Index particle =
      edit.make_particle(at.point, range, influences_from(edit.memberships(at.point)));
  SurfaceFront& front = structure.scratch.front;
  front.begin(structure.points.count(), range, structure.character.edge_length);
  front.add(at.point, 0.0f);
  Index visited = 0;
  front.run(edit.other_ring(), [&](Index point, float distance, Index) {
    ++visited;
    if (is_on_lip(point)) return true;
    const SurfaceFront& band = structure.scratch.band_front;
    float reach = distance / range;
    if (band.has_visited(point))
      reach = std::max(reach, least_reach(chain, band.distance(point), fineness));
    if (reach < 1 && edit.may_join(point, particle)) edit.join(point, {particle, reach});
    return true;
  });
  return visited;
}

}  // namespace sunder::particles
