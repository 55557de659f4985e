#include "tear/surface/join_edges.h"

#include <algorithm>
#include <cmath>

#include "tear/geometry/tolerances.h"
#include "tear/internal/mesh_vertices.h"
#include "tear/surface/face_split.h"

namespace sunder::tear {
namespace {

ScratchVector<Index> corners_of_fan(Index corner, const SurfaceEditor& editor) {
  ScratchVector<Index> fan(&editor.scratch());
  editor.surface().for_each_in_fan(corner, [&](Index c) { fan.push_back(c); });
  return fan;
}

/// Whether a face around a corner's point has another corner at `point`.
bool has_face_with(Index corner, Index point, const Surface& surface) {
  bool found = false;
  surface.for_each_in_fan(corner, [&](Index c) {
    found = found || surface.corner_point[Surface::next(c)] == point ||
            surface.corner_point[Surface::previous(c)] == point;
  });
  return found;
}

bool can_merge_points(Index a, Index b, const SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  const Index at_a = surface.corner_point[a], at_b = surface.corner_point[b];
  if (at_a == at_b) return true;
  const auto& meshes = editor.character().meshes;
  const VertexRef of_a = editor.vertex_ref_at(a), of_b = editor.vertex_ref_at(b);
  return meshes[of_a.mesh].skin == meshes[of_b.mesh].skin &&
         is_same_surface_point(meshes[of_a.mesh], of_a.vertex, meshes[of_b.mesh], of_b.vertex) &&
         !has_face_with(a, at_b, surface) && !has_face_with(b, at_a, surface);
}

/// The vertices of a fan that moves to another point.
class KeptVertices {
 public:
  KeptVertices(std::span<const Index> kept, const SurfaceEditor& editor)
      : kept_(kept), editor_(editor) {}

  /// The vertex of the fan that stays that the one of a corner is a copy of; the latter itself if
  /// there is none.
  [[nodiscard]] Index find(Index corner) const {
    const VertexRef of = editor_.vertex_ref_at(corner);
    const Mesh& mesh = editor_.character().meshes[of.mesh];
    for (const Index at : kept_) {
      const VertexRef other = editor_.vertex_ref_at(at);
      if (other.mesh == of.mesh && is_same_but_for_tear_side(mesh, other.vertex, of.vertex) &&
          is_in_origin(corner, of.vertex, other.vertex))
        return other.vertex;
    }
    return of.vertex;
  }

 private:
  /// Whether a vertex is a part of the origin of a corner's face too, as the one that it has: those
  /// of walls, and of faces whose edges nothing but a place joins, are not.
  [[nodiscard]] bool is_in_origin(Index corner, Index vertex, Index other) const {
    const TriangleRef face = editor_.surface().triangle(corner / 3);
    const auto place = editor_.births.place_in_origin(face, vertex),
               of_other = editor_.births.place_in_origin(face, other);
    for (std::size_t k = 0; k < 3; ++k)
      if (!(std::abs(place[k] - of_other[k]) <= kWeldBarycentric)) return false;
    return true;
  }

  std::span<const Index> kept_;
  const SurfaceEditor& editor_;
};

/// Makes the points of two corners one. There must be room.
void merge_points(Index a, Index b, SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  if (surface.corner_point[a] == surface.corner_point[b]) return;
  if (surface.corner_point[a] > surface.corner_point[b]) std::swap(a, b);
  const Index kept = surface.corner_point[a], lost = surface.corner_point[b];
  const ScratchVector<Index> stays = corners_of_fan(a, editor), moves = corners_of_fan(b, editor);
  for (const Index c : moves) editor.log.keep(c / 3);
  const KeptVertices vertices(stays, editor);
  for (const Index c : moves) {
    const VertexRef before = editor.vertex_ref_at(c);
    const Index vertex = vertices.find(c);
    const auto& is_shared = surface.is_shared_vertex[before.mesh];
    if (vertex == before.vertex && !(vertex < is_shared.size() && is_shared[vertex]))
      editor.sides.write(before.mesh, vertex, surface.side(kept));
    editor.connectivity.set_corner(c, kept, vertex);
  }
  editor.connectivity.set_point_corner(lost, kNone);
}

}  // namespace

bool join_edges(Index a, Index b, SurfaceEditor& editor) {
  const Index after_a = Surface::next(a), after_b = Surface::next(b);
  if (!can_merge_points(a, after_b, editor) || !can_merge_points(after_a, b, editor)) return false;
  const std::size_t corners =
      corners_of_fan(a, editor).size() + corners_of_fan(after_b, editor).size() +
      corners_of_fan(after_a, editor).size() + corners_of_fan(b, editor).size();
  editor.room.make_for_changes(corners + 2);
  editor.room.make_for_welds(0, corners);
  merge_points(a, after_b, editor);
  // If the first end closed on the other end's points, they would be at one place:
  // can_merge_points().
  merge_points(after_a, b, editor);
  editor.log.keep(a / 3);
  editor.log.keep(b / 3);
  editor.connectivity.join(a, b);
  return true;
}

bool move_border_point(Index corner, const std::array<double, 3>& barycentric,
                       const VertexRef& like, SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  const TriangleRef of = surface.triangle(corner / 3);
  const ScratchVector<Index> fan = corners_of_fan(corner, editor);
  const auto is_of_origin = [&](Index c) {
    const TriangleRef ref = surface.triangle(c / 3);
    return ref.mesh == of.mesh && ref.source_triangle == of.source_triangle;
  };
  if (!std::ranges::all_of(fan, is_of_origin)) return false;
  const Mesh& like_mesh = editor.character().meshes[like.mesh];
  if (editor.character().meshes[of.mesh].skin != like_mesh.skin) return false;
  const Triangle& origin = editor.fillings.origin_triangle(of.mesh, of.source_triangle);
  const std::size_t influences =
      editor.room.influence_count(of.mesh, origin) + like_mesh.weights.of(like.vertex).size();
  editor.room.make_for_vertices(of.mesh, 1, static_cast<Index>(influences));
  editor.room.make_for_changes(fan.size());
  const Index vertex = editor.births.append(of.mesh, {of.source_triangle, barycentric});
  copy_surface_point(like_mesh, like.vertex, vertex, editor.mutable_mesh(of.mesh));
  const FaceSplit::Corner moved{vertex, barycentric,
                                place_of(editor.character().meshes[of.mesh].positions[vertex])};
  const auto keeps_winding = [&](Index c) {
    return FaceSplit(editor, c / 3).keeps_winding(c % 3, moved);
  };
  if (!std::ranges::all_of(fan, keeps_winding)) {
    editor.births.remove_newest(of.mesh);
    return false;
  }
  editor.births.set_original_of_newest(of.mesh, editor.births.original(like.mesh, like.vertex));
  const Index point = surface.corner_point[corner];
  editor.sides.write_to_new(of.mesh, vertex, surface.side(point));
  for (const Index c : fan) {
    editor.log.keep(c / 3);
    editor.connectivity.set_corner(c, point, vertex);
  }
  return true;
}

void keep_scars(std::span<const Index> half_edges, SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  editor.room.make_for_welds(half_edges.size(), 0);
  for (const Index h : half_edges)
    editor.connectivity.append_scar(
        {surface.corner_point[h], surface.corner_point[Surface::next(h)]});
}

}  // namespace sunder::tear
