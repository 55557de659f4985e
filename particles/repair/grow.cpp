#include "particles/repair/grow.h"

#include <algorithm>
#include <functional>
#include <limits>

#include "particles/clusters/member_search.h"
#include "particles/repair/cover.h"

namespace sunder::particles {
namespace {

/// If a particle lost its seed: the member with a face that is nearest to it. Otherwise the seed.
Index nearest_member(const StructureEdit& edit, Index particle, std::span<const Index> members) {
  Index seed = edit.structure().particles[particle].seed;
  float nearest = std::numeric_limits<float>::infinity();
  for (const Index point : members) {
    if (edit.surface().point_corner[point] == kNone) continue;
    for (const ParticleMembership& membership : edit.memberships(point)) {
      if (membership.particle != particle || !(membership.reach < nearest)) continue;
      nearest = membership.reach;
      seed = point;
    }
  }
  return seed;
}

}  // namespace

void begin_growing(StructureEdit& edit, Index particle) {
  Structure& structure = edit.structure();
  Index seed = structure.particles[particle].seed;
  if (edit.surface().point_corner[seed] == kNone) {
    MemberSearch search(structure);
    seed = nearest_member(edit, particle, search.members_of(particle));
    edit.move_seed(particle, seed);
  }
  SurfaceFront& front = structure.scratch.band_front;
  front.begin(structure.points.count(), structure.particles[particle].range,
              structure.character.edge_length);
  front.add(seed, 0.0f);
}

std::vector<Index> unreached_members(const StructureEdit& edit, Index particle) {
  const Structure& structure = edit.structure();
  const float range = structure.particles[particle].range;
  std::vector<Index> unreached;
  structure.for_each_candidate(particle, [&](Index point) {
    // A member that the front reached is still one, at the same distance. A point without a face,
    // which a later operation removed, may return when that operation is followed: it stays too.
    if (structure.scratch.band_front.distance(point) < range ||
        edit.surface().point_corner[point] == kNone)
      return;
    if (structure.points.find(point, particle) != nullptr) unreached.push_back(point);
  });
  std::sort(unreached.begin(), unreached.end(), std::greater<>());
  unreached.erase(std::unique(unreached.begin(), unreached.end()), unreached.end());
  return unreached;
}

Index leave_unreached(StructureEdit& edit, Index particle, Index point) {
  edit.keep_if(
      point, [&](const ParticleMembership& membership) { return membership.particle != particle; });
  return 1 + cover(edit, point);
}

}  // namespace sunder::particles
