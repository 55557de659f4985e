#include "particles/repair/grow.h"

#include <limits>

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

Index grow_anew(StructureEdit& edit, Index particle) {
  Structure& structure = edit.structure();
  const float range = structure.particles[particle].range;
  const std::vector<Index> members = structure.members_of(particle);
  Index seed = structure.particles[particle].seed;
  if (edit.surface().point_corner[seed] == kNone)
    edit.change_particle(particle).seed = seed = nearest_member(edit, particle, members);
  SurfaceFront& front = structure.scratch.front;
  front.begin(structure.points.count(), range, structure.edge_length);
  front.add(seed, 0.0f);
  front.run(edit.ring(), [](Index, float, Index) { return true; });
  std::vector<Index> left;
  for (const Index point : members) {
    if (front.distance(point) < range) continue;  // still a member, at the same distance
    // A point without a face, which a later operation removed, may return when that operation is
    // followed. It stays a member until then.
    if (edit.surface().point_corner[point] == kNone) continue;
    left.push_back(point);
    edit.keep_if(point, [&](const ParticleMembership& membership) {
      return membership.particle != particle;
    });
  }
  for (const Index point : left) cover(edit, point);
  return static_cast<Index>(members.size());
}

}  // namespace sunder::particles
