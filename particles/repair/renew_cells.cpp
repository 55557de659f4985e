#include "particles/repair/renew_cells.h"

#include <algorithm>

#include "particles/clusters/cells.h"

namespace sunder::particles {
namespace {

/// The index in the surface of a mesh's triangle.
Index surface_triangle(const Surface& surface, Index mesh, Index triangle) {
  const Index of_source = surface.first_triangle[mesh + 1] - surface.first_triangle[mesh];
  if (triangle < of_source) return surface.first_triangle[mesh] + triangle;
  // Those of a mesh ascend; those of other meshes may be between them.
  std::size_t at = triangle - of_source;
  while (at < surface.appended.size() &&
         (surface.appended[at].mesh != mesh || surface.appended[at].triangle != triangle))
    ++at;
  return at < surface.appended.size() ? surface.first_triangle.back() + static_cast<Index>(at)
                                      : kNone;
}

/// Adds faces to cells or removes them.
class CellEdit {
 public:
  explicit CellEdit(StructureEdit& edit) : edit_(edit) {}

  /// @param sign  1 with the owners of now, -1 with those from before the edit.
  void add(const std::array<Index, 3>& points, int sign) {
    const Structure& structure = edit_.structure();
    std::array<Index, 3> owners = owners_of(structure, points);
    if (sign < 0)
      for (std::size_t k = 0; k < 3; ++k) owners[k] = edit_.owner_before(points[k]);
    for_each_cell_part(
        structure.points.positions, points, owners,
        [&](Index p, double area) { edit_.change_particle(p).area += sign * area; },
        [&](Index p, Index q, const Vec3d& across, const Vec3d& middle) {
          add_border(edit_.change_particle(p), q, sign, across, middle);
          add_border(edit_.change_particle(q), p, sign, Vec3d(-across), middle);
          touched_.push_back(p);
          touched_.push_back(q);
        });
  }

  /// Computes the couplings that may have changed.
  void finish() {
    const Structure& structure = edit_.structure();
    const std::span<const Index> moved = edit_.moved_seeds();
    touched_.insert(touched_.end(), moved.begin(), moved.end());
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    for (const Index p : touched_)
      for (std::size_t i = 0; i < structure.particles[p].neighbours.size(); ++i) {
        const ParticleNeighbour& neighbour = structure.particles[p].neighbours[i];
        const double coupling = coupling_of(structure, p, neighbour);
        if (coupling == neighbour.coupling) continue;
        const Index q = neighbour.particle;
        set_coupling(p, q, coupling);
        set_coupling(q, p, coupling);
      }
  }

 private:
  void set_coupling(Index particle, Index other, double coupling) {
    std::vector<ParticleNeighbour>& neighbours = edit_.change_particle(particle).neighbours;
    const auto at = std::ranges::lower_bound(neighbours, other, {}, &ParticleNeighbour::particle);
    if (at != neighbours.end() && at->particle == other) at->coupling = coupling;
  }

  StructureEdit& edit_;
  std::vector<Index> touched_;
};

/// Computes all cells again.
void recount(StructureEdit& edit) {
  Structure& structure = edit.structure();
  for (Index p = 0; p < structure.particles.size(); ++p) {
    Particle& particle = edit.change_particle(p);
    particle.area = 0;
    particle.neighbours.clear();
  }
  sum_cells(edit.surface(), structure);
}

bool is_rewritten(const RewrittenFaces& rewritten, Index triangle) {
  return std::ranges::binary_search(rewritten.faces, triangle, {}, &RewrittenFaces::Face::triangle);
}

/// Moves the other faces around a point from its former cell to the new one. A face around several
/// such points is moved at the lowest of them.
void move_faces(const StructureEdit& edit, const RewrittenFaces& rewritten, Index point,
                CellEdit& cells) {
  const Surface& surface = edit.surface();
  const Structure& structure = edit.structure();
  const auto has_moved = [&](Index of) {
    return edit.owner_before(of) != structure.points.owners[of];
  };
  surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) {
    const Index triangle = corner / 3;
    if (triangle >= structure.tears.triangle_count || is_rewritten(rewritten, triangle) ||
        !has_cells(surface, triangle))
      return;
    const std::array<Index, 3> points = points_of(surface, triangle);
    if (std::ranges::any_of(points, [&](Index of) { return of < point && has_moved(of); })) return;
    cells.add(points, -1);
    cells.add(points, +1);
  });
}

}  // namespace

RewrittenFaces find_rewritten_faces(const TornModel& model, const Structure& structure,
                                    std::span<const ChangeRecord> changes) {
  RewrittenFaces found;
  const Surface& surface = model.surface();
  const VertexPoints& points = structure.vertex_points;
  const auto add = [&](Index triangle, Index mesh, const Triangle& before) {
    RewrittenFaces::Face face{triangle, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Index vertex = before[k];
      if (vertex >= points.of_mesh[mesh].size()) return;
      face.points[k] = points.of_mesh[mesh][vertex];
      if (!points.shared.empty()) found.is_ambiguous |= points.shared.contains({mesh, vertex});
    }
    found.faces.push_back(face);
  };
  const auto sort_once = [&] {
    // Of a face that several calls rewrote the first one has the points that are known.
    std::ranges::stable_sort(found.faces, {}, &RewrittenFaces::Face::triangle);
    const auto same = [](const auto& a, const auto& b) { return a.triangle == b.triangle; };
    found.faces.erase(std::unique(found.faces.begin(), found.faces.end(), same), found.faces.end());
  };
  for (const ChangeRecord& change : changes)
    for (const MeshChange& of_mesh : change.meshes)
      for (const RewrittenTriangle& rewritten : of_mesh.rewritten) {
        const Index triangle = surface_triangle(surface, of_mesh.mesh, rewritten.triangle);
        if (triangle < structure.tears.triangle_count)
          add(triangle, of_mesh.mesh, rewritten.before);
      }
  sort_once();
  // A tear along a seam gives faces other points, although they keep their vertices.
  const std::size_t rewritten_count = found.faces.size();
  const auto add_if_kept = [&](Index corner) {
    const Index triangle = corner / 3;
    if (triangle >= structure.tears.triangle_count ||
        std::ranges::binary_search(std::span(found.faces).first(rewritten_count), triangle, {},
                                   &RewrittenFaces::Face::triangle))
      return;
    const tear::TriangleRef ref = surface.triangle(triangle);
    add(triangle, ref.mesh, model.character().meshes[ref.mesh].triangles[ref.triangle]);
  };
  for (Index point = structure.points.count(); point < surface.point_count(); ++point)
    if (surface.point_corner[point] != kNone)
      surface.for_each_in_fan(surface.point_corner[point], add_if_kept);
  if (found.faces.size() > rewritten_count) sort_once();
  return found;
}

void renew_cells(StructureEdit& edit, const RewrittenFaces& rewritten) {
  if (rewritten.is_ambiguous) {
    recount(edit);
    return;
  }
  const Surface& surface = edit.surface();
  const Structure& structure = edit.structure();
  CellEdit cells(edit);
  const auto is_counted = [&](const std::array<Index, 3>& points) {
    const auto& [a, b, c] = points;
    return a != kNone && b != kNone && c != kNone && a != b && b != c && c != a;
  };
  for (const RewrittenFaces::Face& face : rewritten.faces) {
    if (is_counted(face.points) && !is_filling(surface, face.triangle)) cells.add(face.points, -1);
    if (has_cells(surface, face.triangle)) cells.add(points_of(surface, face.triangle), +1);
  }
  for (Index t = structure.tears.triangle_count; t < surface.triangle_count(); ++t)
    if (has_cells(surface, t)) cells.add(points_of(surface, t), +1);
  for (std::size_t i = 0; i < edit.taken_up_count(); ++i) {
    const Index point = edit.taken_up(i);
    // All faces around new points are new or rewritten.
    if (point < edit.first_new_point() && surface.point_corner[point] != kNone &&
        edit.owner_before(point) != structure.points.owners[point])
      move_faces(edit, rewritten, point, cells);
  }
  cells.finish();
}

}  // namespace sunder::particles
