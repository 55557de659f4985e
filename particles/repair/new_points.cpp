#include "particles/repair/new_points.h"

#include <algorithm>
#include <cmath>

#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// The distance of a point from a particle's seed, through a neighbour that is a member and, if
/// there is one, the face between that neighbour and the next one.
/// @param i          the neighbour in the ring around the point.
/// @param next       memberships of the next neighbour; empty if it has none yet.
float distance_through(const Ring& around, std::size_t i, const ParticleMembership& membership,
                       float range, std::span<const ParticleMembership> next) {
  const float at = membership.reach * range;
  float distance = at + around.length(i);
  for (const ParticleMembership& beside : next) {
    if (beside.particle != membership.particle) continue;
    const float square = one_by_one::square_across(around.opposite(i), around.length(i),
                                                   around.length(i + 1), at, beside.reach * range);
    distance = std::min(distance, std::sqrt(square));
  }
  return distance;
}

/// Gives a point the memberships of the i-th point around it.
/// @param has_next  whether the next one around has memberships too.
void spread_from(StructureEdit& edit, Index point, const Ring& around, std::size_t i, bool has_next,
                 Index undecided_tear) {
  const Index from = around.point(i);
  // Read again in each iteration, because join() moves memberships.
  for (std::size_t m = 0; m < edit.memberships(from).size(); ++m) {
    const ParticleMembership membership = edit.memberships(from)[m];
    if (!edit.may_join(point, membership.particle, undecided_tear)) continue;
    std::span<const ParticleMembership> next;
    if (has_next) next = edit.memberships(around.point(i + 1));
    const float range = edit.structure().particles[membership.particle].range;
    const float distance = distance_through(around, i, membership, range, next);
    if (distance < range) edit.join(point, {membership.particle, distance / range});
  }
}

/// Gives a point the memberships of those neighbours that have some. @return false if none has.
bool spread_to(StructureEdit& edit, Index point, Index undecided_tear) {
  const Marks& is_ready = edit.structure().scratch.seen;
  const Ring around = edit.ring()(point);
  const auto knows = [&](Index other) {
    return other < edit.first_new_point() || is_ready.has(other);
  };
  bool has_any = false;
  for (std::size_t i = 0; i < around.size(); ++i) {
    if (!knows(around.point(i))) continue;
    has_any = true;
    const bool has_next = i + 1 < around.size() && knows(around.point(i + 1));
    spread_from(edit, point, around, i, has_next, undecided_tear);
  }
  return has_any;
}

}  // namespace

void append_points(StructureEdit& edit) {
  const Character& character = edit.model().character();
  Structure& structure = edit.structure();
  PointTable& points = structure.points;
  for (Index point = edit.first_new_point(); point < edit.surface().point_count(); ++point) {
    const VertexRef of = vertex_of(edit.model(), point);
    Vec3f position = Vec3f::Zero();
    if (of.vertex != kNone)
      position = structure.character.decomposition_pose.place(character.meshes[of.mesh], of.vertex);
    structure.journal.points.add(point);
    points.vertices.push_back(of);
    points.positions.push_back(position);
    points.slabs.emplace_back();
    points.influences.emplace_back();
    points.owners.push_back(kNone);
    points.lip_points.emplace_back();
  }
  structure.authored.follow(edit.model(), points.vertices, edit.first_new_point());
  for (Index m = 0; m < character.meshes.size(); ++m) {
    std::vector<Index>& of_mesh = structure.vertex_points.of_mesh[m];
    for (auto v = static_cast<Index>(of_mesh.size()); v < character.meshes[m].vertex_count(); ++v)
      structure.journal.vertices.add({m, v});
    of_mesh.resize(character.meshes[m].vertex_count(), kNone);
  }
}

void spread_to_new_points(StructureEdit& edit, Index undecided_tear) {
  const Index count = edit.structure().points.count();
  Marks& is_ready = edit.structure().scratch.seen;
  is_ready.begin(count);
  std::vector<Index> open, ready, later;
  for (Index point = edit.first_new_point(); point < count; ++point)
    if (edit.surface().point_corner[point] != kNone) open.push_back(point);
  while (!open.empty()) {
    ready.clear();
    later.clear();
    for (const Index point : open)
      (spread_to(edit, point, undecided_tear) ? ready : later).push_back(point);
    for (const Index point : open) edit.take_up(point);
    if (ready.empty()) return;
    for (const Index point : ready) is_ready.mark(point);
    open.swap(later);
  }
}

}  // namespace sunder::particles
