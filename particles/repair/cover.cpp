#include "particles/repair/cover.h"

#include <algorithm>

#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

/// The influences of a point before the tear; for a point created by it, those of a neighbour.
ParticleInfluences influences_before(StructureEdit& edit, Index point) {
  const Change& change = edit.change();
  if (point < change.points) {
    for (std::size_t i = 0; i < change.changed_points.size(); ++i)
      if (change.changed_points[i].point == point) return change.changed_points[i].influences;
    return edit.structure().points.influences[point];
  }
  const Ring around = edit.other_ring()(point);
  for (std::size_t i = 0; i < around.size(); ++i)
    if (around.point(i) < change.points) return influences_before(edit, around.point(i));
  return {};
}

}  // namespace

Index cover(StructureEdit& edit, Index point) {
  if (edit.surface().point_corner[point] == kNone) return 0;
  const auto covers = [](const ParticleMembership& membership) {
    return membership.reach < kUncoveredReach;
  };
  if (std::ranges::any_of(edit.memberships(point), covers)) return 0;
  Structure& structure = edit.structure();
  const auto range = static_cast<float>(structure.report.range);
  const Index particle = edit.make_particle(point, range, influences_before(edit, point));
  SurfaceFront& front = structure.scratch.front;
  front.begin(structure.points.count(), range, structure.character.edge_length);
  front.add(point, 0.0f);
  Index visited = 0;
  front.run(edit.other_ring(), [&](Index member, float distance, Index) {
    if (edit.may_join(member, particle)) edit.join(member, {particle, distance / range});
    ++visited;
    return true;
  });
  return visited;
}

void cover_taken_up(StructureEdit& edit) {
  for (std::size_t i = 0; i < edit.taken_up_count(); ++i) (void)cover(edit, edit.taken_up(i));
}

}  // namespace sunder::particles
