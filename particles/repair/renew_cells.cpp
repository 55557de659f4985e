#include "particles/repair/renew_cells.h"

#include <algorithm>

#include "particles/clusters/border_table.h"
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

/// Adds faces to cells or removes them. Their parts are summed first, since many are of the same
/// few cells.
class CellEdit {
 public:
  explicit CellEdit(StructureEdit& edit)
      : edit_(edit), scratch_(edit.structure().scratch), borders_(kFewPairs) {
    const std::size_t count = edit.structure().particles.size();
    scratch_.has_area_change.begin(count);
    if (scratch_.area_change.size() < count) scratch_.area_change.resize(count + count / 8 + 16);
  }

  /// Adds a face with the owners of now.
  void add(const std::array<Index, 3>& points) {
    divide(face_of(points), owners_of(edit_.structure(), points), 1);
  }
  /// Removes a face with the owners from before the edit.
  void remove(const std::array<Index, 3>& points) {
    divide(face_of(points), owners_before(points), -1);
  }
  /// Moves a face from the owners from before the edit to those of now.
  void move(const std::array<Index, 3>& points) {
    const FaceOfCells face = face_of(points);
    divide(face, owners_before(points), -1);
    divide(face, owners_of(edit_.structure(), points), 1);
  }

  /// Writes the sums, and the couplings that they may change.
  void finish() {
    for (const Index p : changed_) edit_.change_particle(p).area += scratch_.area_change[p];
    borders_.for_each([&](const BorderTable::Entry& of) {
      change_border(of.low(), of.high(), of.edges, of.across, of.middles);
      change_border(of.high(), of.low(), of.edges, Vec3d(-of.across), of.middles);
    });
    borders_.for_each([&](const BorderTable::Entry& of) { couple(of.low(), of.high()); });
    for (const Index p : edit_.moved_seeds()) {
      const std::vector<ParticleNeighbour>& neighbours = edit_.structure().particles[p].neighbours;
      for (std::size_t i = 0; i < neighbours.size(); ++i) couple(p, neighbours[i].particle);
    }
  }

 private:
  /// Number of pairs of cells at whose borders a typical operation changes faces.
  static constexpr std::size_t kFewPairs = 100;

  [[nodiscard]] FaceOfCells face_of(const std::array<Index, 3>& points) const {
    return {edit_.structure().points.positions, points};
  }
  [[nodiscard]] std::array<Index, 3> owners_before(const std::array<Index, 3>& points) const {
    return {edit_.owner_before(points[0]), edit_.owner_before(points[1]),
            edit_.owner_before(points[2])};
  }

  void divide(const FaceOfCells& face, const std::array<Index, 3>& owners, int sign) {
    face.divide(
        owners,
        [&](Index p, double area) {
          if (scratch_.has_area_change.mark(p)) {
            scratch_.area_change[p] = 0;
            changed_.push_back(p);
          }
          scratch_.area_change[p] += sign * area;
        },
        [&](Index p, Index q, const Vec3d& across, const Vec3d& middle) {
          borders_.add(p, q, sign, across, middle);
        });
  }

  /// Adds to the border of a particle with another one; without edges it is removed.
  void change_border(Index particle, Index other, int edges, const Vec3d& across,
                     const Vec3d& middles) {
    std::vector<ParticleNeighbour>& neighbours = edit_.change_particle(particle).neighbours;
    auto at = std::ranges::lower_bound(neighbours, other, {}, &ParticleNeighbour::particle);
    if (at == neighbours.end() || at->particle != other) {
      if (edges <= 0) return;
      at = neighbours.insert(at, ParticleNeighbour{.particle = other});
    }
    at->edges = static_cast<Index>(std::int64_t{at->edges} + edges);
    at->across += across;
    at->middles += middles;
    if (at->edges == 0) neighbours.erase(at);
  }

  void couple(Index p, Index q) {
    const ParticleNeighbour* of = neighbour_of(p, q);
    if (of == nullptr) return;
    const double coupling = coupling_of(edit_.structure(), p, *of);
    if (coupling == of->coupling) return;
    edit_.change_particle(p);
    edit_.change_particle(q);
    neighbour_of(p, q)->coupling = coupling;
    if (ParticleNeighbour* back = neighbour_of(q, p)) back->coupling = coupling;
  }

  [[nodiscard]] ParticleNeighbour* neighbour_of(Index particle, Index other) const {
    std::vector<ParticleNeighbour>& neighbours = edit_.structure().particles[particle].neighbours;
    const auto at = std::ranges::lower_bound(neighbours, other, {}, &ParticleNeighbour::particle);
    return at != neighbours.end() && at->particle == other ? &*at : nullptr;
  }

  StructureEdit& edit_;
  RepairScratch& scratch_;
  BorderTable borders_;
  std::vector<Index> changed_;  ///< Particles whose area changes.
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
    cells.move(points);
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
    // Of a face that several calls rewrote the first one has the points that are known. A single
    // change of a single mesh lists them in order.
    if (!std::ranges::is_sorted(found.faces, {}, &RewrittenFaces::Face::triangle))
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
  for (const ChangeRecord& change : changes)
    for (const WeldedPoint& point : change.welded)
      if (surface.point_corner[point.kept] != kNone)
        surface.for_each_in_fan(surface.point_corner[point.kept], add_if_kept);
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
    if (is_counted(face.points) && !is_filling(surface, face.triangle)) cells.remove(face.points);
    if (has_cells(surface, face.triangle)) cells.add(points_of(surface, face.triangle));
  }
  for (Index t = structure.tears.triangle_count; t < surface.triangle_count(); ++t)
    if (has_cells(surface, t)) cells.add(points_of(surface, t));
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
