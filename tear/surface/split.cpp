#include "tear/surface/split.h"

#include "tear/surface/face_split.h"
#include "tear/surface/line_splitter.h"

namespace sunder::tear {

Index split_edge(Index half_edge, double fraction, SurfaceEditor& editor, Rounding rounding) {
  LineSplitter splitter(editor);
  const Index point = splitter.begin(half_edge, fraction, rounding);
  if (point != kNone) splitter.end();
  return point;
}

Index split_triangle(Index triangle, const std::array<double, 3>& barycentric,
                     SurfaceEditor& editor) {
  Connectivity& connectivity = editor.connectivity;
  Surface& surface = connectivity.surface();
  const FaceSplit split(editor, triangle);
  const Index mesh = split.mesh();
  editor.room.make_for_vertices(mesh, 1, editor.room.influence_count(mesh, split.vertices()));
  editor.room.make_for_triangles(mesh, 2);
  editor.room.make_for_changes(3);
  const Birth birth = split.birth_at(barycentric);
  const Index vertex = editor.births.append(mesh, birth);
  const Index corner = 3 * triangle;
  const FaceSplit::Corner made{vertex, birth.barycentric,
                               place_of(editor.character().meshes[mesh].positions[vertex])};
  if (!split.keeps_winding(0, made) || !split.keeps_winding(1, made) ||
      !split.keeps_winding(2, made)) {
    editor.births.remove_newest(mesh);
    return kNone;
  }
  // (a, b, c) -> (a, b, p) in place, (b, c, p), (c, a, p).
  const Triangle& before = split.vertices();
  const Index a = surface.corner_point[corner], b = surface.corner_point[corner + 1],
              c = surface.corner_point[corner + 2];
  const Index twin_bc = surface.twin[corner + 1], twin_ca = surface.twin[corner + 2];
  editor.log.keep(triangle);
  if (twin_bc != kNone) editor.log.keep(twin_bc / 3);
  if (twin_ca != kNone) editor.log.keep(twin_ca / 3);
  const Index p = connectivity.append_point();
  editor.sides.write_to_new(mesh, vertex, surface.side(p));
  const Index at_bc =
      3 * connectivity.append_part(triangle, {b, c, p}, {before[1], before[2], vertex});
  const Index at_ca =
      3 * connectivity.append_part(triangle, {c, a, p}, {before[2], before[0], vertex});
  connectivity.set_corner(corner + 2, p, vertex);
  editor.opened_edges.move(corner + 1, at_bc);
  editor.opened_edges.move(corner + 2, at_ca);
  connectivity.join(at_bc, twin_bc);
  connectivity.join(at_ca, twin_ca);
  connectivity.join(corner + 1, at_bc + 2);
  connectivity.join(at_bc + 1, at_ca + 2);
  connectivity.join(at_ca + 1, corner + 2);
  surface.point_corner[p] = corner + 2;
  surface.point_corner[a] = corner;
  surface.point_corner[b] = corner + 1;
  surface.point_corner[c] = at_ca;
  return p;
}

}  // namespace sunder::tear
