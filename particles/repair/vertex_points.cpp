#include "particles/repair/vertex_points.h"

#include "particles/clusters/torn_meshes.h"

namespace sunder::particles {
namespace {

/// Calls visit(vertex) for each corner that the triangles rewritten by a call had before.
template <class Visit>
void for_each_corner_before(const MeshChange& of_mesh, Visit visit) {
  for (const RewrittenTriangle& rewritten : of_mesh.rewritten)
    for (const Index vertex : rewritten.before) visit(vertex);
}

/// A point without a face belongs to no particle.
void leave_if_lost(StructureEdit& edit, Index point, std::vector<Index>& lost) {
  if (point >= edit.structure().points.count() || edit.surface().point_corner[point] != kNone)
    return;
  if (edit.memberships(point).empty()) return;
  edit.leave_all(point);
  lost.push_back(point);
}

void set_vertex_point(StructureEdit& edit, Index mesh, Index vertex, Index point) {
  Index& known = edit.structure().vertex_points.of_mesh[mesh][vertex];
  if (vertex < edit.change().vertices[mesh])
    edit.change().changed_vertices.push_back({mesh, vertex, known});
  edit.structure().journal.vertices.add({mesh, vertex});
  known = point;
}

bool has_vertex(const StructureEdit& edit, Index point, Index mesh, Index vertex) {
  return particles::has_vertex(edit.model(), point, mesh, vertex);
}

/// Writes the point of a corner's vertex.
void renew_corner(StructureEdit& edit, Index corner) {
  VertexPoints& points = edit.structure().vertex_points;
  const tear::TriangleRef ref = edit.surface().triangle(corner / 3);
  const Index vertex = vertex_at(edit.model(), ref, corner);
  const Index known = points.of_mesh[ref.mesh][vertex], now = edit.surface().corner_point[corner];
  if (known == now) return;
  if (known != kNone && has_vertex(edit, known, ref.mesh, vertex))
    points.share(ref.mesh, vertex, known, now);
  set_vertex_point(edit, ref.mesh, vertex, now);
}

/// A vertex that several points share may have lost its stored point; then it gets another one of
/// them.
void renew_shared_vertex(StructureEdit& edit, Index mesh, Index vertex, std::vector<Index>& lost) {
  VertexPoints& points = edit.structure().vertex_points;
  const auto shared = points.shared.find({mesh, vertex});
  if (shared == points.shared.end()) return;
  for (const Index point : shared->second) leave_if_lost(edit, point, lost);
  if (has_vertex(edit, points.of_mesh[mesh][vertex], mesh, vertex)) return;
  for (const Index point : shared->second) {
    if (!has_vertex(edit, point, mesh, vertex)) continue;
    set_vertex_point(edit, mesh, vertex, point);
    return;
  }
}

/// A vertex that no face uses any more has no point.
void forget_if_unused(StructureEdit& edit, Index mesh, Index vertex) {
  const Index point = edit.structure().vertex_points.of_mesh[mesh][vertex];
  if (point != kNone && !has_vertex(edit, point, mesh, vertex))
    set_vertex_point(edit, mesh, vertex, kNone);
}

}  // namespace

std::vector<Index> leave_lost_points(StructureEdit& edit, std::span<const ChangeRecord> changes) {
  std::vector<Index> lost;
  const auto leave_in = [&](const MeshChange& of_mesh) {
    if (of_mesh.retired.empty()) return;
    for_each_corner_before(of_mesh, [&](Index vertex) {
      const Index point = edit.structure().vertex_points.of_mesh[of_mesh.mesh][vertex];
      if (point != kNone) leave_if_lost(edit, point, lost);
    });
  };
  for (const ChangeRecord& change : changes)
    for (const MeshChange& of_mesh : change.meshes) leave_in(of_mesh);
  return lost;
}

void renew_vertex_points(StructureEdit& edit, std::span<const ChangeRecord> changes,
                         std::vector<Index>& lost) {
  const Structure& structure = edit.structure();
  const Surface& surface = edit.surface();
  const auto renew = [&](Index corner) { renew_corner(edit, corner); };
  // Vertices are either new, or belong to a new point.
  for (Index point = edit.first_new_point(); point < structure.points.count(); ++point)
    if (surface.point_corner[point] != kNone)
      surface.for_each_in_fan(surface.point_corner[point], renew);
  for (Index corner = 3 * structure.tears.triangle_count; corner < surface.corner_point.size();
       ++corner)
    if (!surface.has_repeated_point(corner / 3)) renew(corner);
  for (const ChangeRecord& change : changes)
    for (const WeldedPoint& point : change.welded)
      if (surface.point_corner[point.kept] != kNone)
        surface.for_each_in_fan(surface.point_corner[point.kept], renew);
  const bool has_shared = !structure.vertex_points.shared.empty();
  const auto renew_before = [&](const MeshChange& of_mesh, bool may_lose) {
    for_each_corner_before(of_mesh, [&](Index vertex) {
      if (has_shared) renew_shared_vertex(edit, of_mesh.mesh, vertex, lost);
      if (may_lose) forget_if_unused(edit, of_mesh.mesh, vertex);
    });
  };
  for (const ChangeRecord& change : changes)
    for (const MeshChange& of_mesh : change.meshes)
      renew_before(of_mesh, !of_mesh.retired.empty() || !change.welded.empty());
}

}  // namespace sunder::particles
