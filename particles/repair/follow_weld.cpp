#include "particles/repair/follow_weld.h"

#include <algorithm>

#include "particles/repair/lip_edges.h"
#include "particles/repair/vertex_points.h"

namespace sunder::particles {
namespace {

template <class Visit>
void for_each_welded(std::span<const ChangeRecord> changes, Visit visit) {
  for (const ChangeRecord& change : changes)
    for (const WeldedPoint& point : change.welded) visit(point);
}

/// A point that is in the structure, unlike one that the weld itself made.
bool is_known(const StructureEdit& edit, Index point) {
  return point < edit.structure().points.count();
}

using Lips = std::vector<Particle::OfTear>;

Lips lips_of(const PointTable& points, Index point) {
  Lips lips;
  points.for_each_lip(point, [&](Index tear, Side side) { lips.push_back({tear, side}); });
  return lips;
}

/// The lips of two points that are one now. On a lip whose two sides meet in it a point is no more.
Lips common_lips(const Lips& a, const Lips& b) {
  Lips common;
  const auto add = [&](const Particle::OfTear& of, const Lips& other) {
    const auto at = std::ranges::find(other, of.tear, &Particle::OfTear::tear);
    const bool is_listed =
        std::ranges::find(common, of.tear, &Particle::OfTear::tear) != common.end();
    if ((at == other.end() || at->side == of.side) && !is_listed) common.push_back(of);
  };
  for (const Particle::OfTear& of : a) add(of, b);
  for (const Particle::OfTear& of : b) add(of, a);
  std::ranges::sort(common, {}, &Particle::OfTear::tear);
  return common;
}

void put_on_lips(StructureEdit& edit, Index point, const Lips& lips) {
  PointTable& points = edit.structure().points;
  edit.log_point(point);
  LipPoint cleared;
  cleared.edge = points.lip_points[point].edge;
  points.lip_points[point] = cleared;
  for (const Particle::OfTear& of : lips) points.put_on_lip(point, of.tear, of.side);
}

/// The particles that have a welded point or one next to it.
std::vector<Index> particles_at_welds(StructureEdit& edit, std::span<const ChangeRecord> changes) {
  std::vector<Index> particles;
  const auto add = [&](Index point) {
    for (const ParticleMembership& membership : edit.memberships(point))
      particles.push_back(membership.particle);
  };
  for_each_welded(changes, [&](const WeldedPoint& of) {
    add(of.kept);
    const Ring around = edit.ring()(of.kept);
    for (std::size_t i = 0; i < around.size(); ++i) add(around.point(i));
  });
  std::ranges::sort(particles);
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  return particles;
}

/// Gives a particle all points that its range reaches from its seed.
void reach_out(StructureEdit& edit, Index particle) {
  Structure& structure = edit.structure();
  const Index seed = structure.particles[particle].seed;
  if (edit.surface().point_corner[seed] == kNone) return;
  const float range = structure.particles[particle].range;
  SurfaceFront& front = structure.scratch.front;
  front.begin(structure.points.count(), range, structure.character.edge_length);
  front.add(seed, 0.0f);
  front.run(edit.other_ring(), [&](Index point, float distance, Index) {
    if (edit.may_join(point, particle)) edit.join(point, {particle, distance / range});
    return true;
  });
}

}  // namespace

void leave_welded_points(StructureEdit& edit, std::span<const ChangeRecord> changes,
                         std::vector<Index>& lost) {
  for_each_welded(changes, [&](const WeldedPoint& of) {
    if (of.lost == of.kept || !is_known(edit, of.lost)) return;
    for (const ParticleMembership& membership : edit.memberships(of.lost))
      if (edit.structure().particles[membership.particle].seed == of.lost)
        edit.move_seed(membership.particle, of.kept);
    if (edit.memberships(of.lost).empty()) return;
    edit.leave_all(of.lost);
    lost.push_back(of.lost);
  });
}

void reach_across_welds(StructureEdit& edit, std::span<const ChangeRecord> changes) {
  const PointTable& points = edit.structure().points;
  bool has_welds = false;
  for_each_welded(changes, [&](const WeldedPoint& of) {
    has_welds = true;
    if (of.lost == of.kept || !is_known(edit, of.lost)) return;
    put_on_lips(edit, of.kept, common_lips(lips_of(points, of.kept), lips_of(points, of.lost)));
  });
  if (!has_welds) return;
  for (const Index particle : particles_at_welds(edit, changes)) reach_out(edit, particle);
}

void renew_welded_lip_edges(StructureEdit& edit, std::span<const ChangeRecord> changes) {
  for_each_welded(changes, [&](const WeldedPoint& of) { revise_lip_edges(edit, of.kept); });
}

}  // namespace sunder::particles
