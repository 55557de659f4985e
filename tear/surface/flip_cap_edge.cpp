#include "tear/surface/flip_cap_edge.h"

#include <algorithm>

#include "tear/geometry/face_shape.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/surface/append_filling.h"
#include "tear/surface/disconnect.h"

namespace sunder::tear {
namespace {

/// Whether a face is a triangle of a cap or wall as it was made.
bool is_whole_filling(const TriangleRef& face, const SurfaceEditor& editor) {
  const Index source_count = editor.source().meshes[face.mesh].triangle_count();
  return face.source_triangle >= source_count &&
         is_same(editor.character().meshes[face.mesh].triangles[face.triangle],
                 editor.fillings.origin_triangle(face.mesh, face.source_triangle));
}

/// Two triangles of a cap, (a, b, c) and (b, a, d): points and vertices of a, b, c, d, and the
/// half-edges beyond bc, ca, ad and db.
struct CapQuadrilateral {
  Index face, other;
  std::array<Index, 4> points, vertices;
  Index beyond_bc, beyond_ca, beyond_ad, beyond_db;
};

std::optional<CapQuadrilateral> quadrilateral_at(Index half_edge, const SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  const Index twin = surface.twin[half_edge];
  if (twin == kNone || std::min(half_edge, twin) / 3 < surface.first_triangle.back())
    return std::nullopt;
  const Index bc = Surface::next(half_edge), ca = Surface::previous(half_edge),
              ad = Surface::next(twin), db = Surface::previous(twin);
  const TriangleRef f = surface.triangle(half_edge / 3), g = surface.triangle(twin / 3);
  const auto group_of = [&](const TriangleRef& filling) {
    return editor.fillings.group(filling.mesh, filling.source_triangle);
  };
  if (f.mesh != g.mesh || !is_whole_filling(f, editor) || !is_whole_filling(g, editor) ||
      group_of(f) != group_of(g) || editor.fillings.is_wall(f) ||
      editor.vertex_at(half_edge) != editor.vertex_at(ad) ||
      editor.vertex_at(bc) != editor.vertex_at(twin))
    return std::nullopt;
  const auto point = [&](Index corner) { return surface.corner_point[corner]; };
  return CapQuadrilateral{half_edge / 3,
                          twin / 3,
                          {point(half_edge), point(bc), point(ca), point(db)},
                          {editor.vertex_at(half_edge), editor.vertex_at(bc), editor.vertex_at(ca),
                           editor.vertex_at(db)},
                          surface.twin[bc],
                          surface.twin[ca],
                          surface.twin[ad],
                          surface.twin[db]};
}

/// Whether the corners lie in a plane in bind space, and the other diagonal leaves faces of a
/// shape.
bool leaves_flat_faces(const CapQuadrilateral& of, double least_shape_factor,
                       const SurfaceEditor& editor) {
  const Index mesh = editor.surface().triangle(of.face).mesh;
  std::array<Place, 4> at;
  for (std::size_t k = 0; k < 4; ++k)
    at[k] = place_of(editor.births.position(mesh, of.vertices[k]));
  const auto& [a, b, c, d] = at;
  const Place before = normal(a, b, c), to_d = way(a, d);
  const double height = dot(to_d, before);
  if (height * height > kFlatCapSines * kFlatCapSines * dot(before, before) * dot(to_d, to_d))
    return false;
  const Place of_first = normal(a, d, c), of_second = normal(b, c, d);
  if (!(dot(before, of_first) > 0) || !(dot(before, of_second) > 0)) return false;
  const double shape_before = std::min(shape_squared(a, b, c), shape_squared(b, a, d)),
               shape_after =
                   std::min(shape_squared(a, d, c, of_first), shape_squared(b, c, d, of_second));
  return shape_after > least_shape_factor * least_shape_factor * shape_before;
}

}  // namespace

std::optional<std::array<Index, 2>> flip_cap_edge(Index half_edge, double least_shape_factor,
                                                  SurfaceEditor& editor) {
  const auto of = quadrilateral_at(half_edge, editor);
  if (!of) return std::nullopt;
  const Surface& surface = editor.surface();
  const auto [a, b, c, d] = of->points;
  if (c == d || surface.find_half_edge(c, d) != kNone || surface.find_half_edge(d, c) != kNone ||
      !leaves_flat_faces(*of, least_shape_factor, editor))
    return std::nullopt;
  const TriangleRef face = surface.triangle(of->face);
  const FillingSubmesh of_cap = {
      face.mesh, editor.character().meshes[face.mesh].triangle_submesh[face.triangle],
      editor.fillings.group(face.mesh, face.source_triangle)};
  const auto [vertex_a, vertex_b, vertex_c, vertex_d] = of->vertices;
  editor.room.make_for_changes(4);
  for (const Index beyond : {of->beyond_bc, of->beyond_ca, of->beyond_ad, of->beyond_db})
    if (beyond != kNone) editor.log.keep(beyond / 3);
  retire_triangle(of->face, editor);
  retire_triangle(of->other, editor);
  const Index first = append_filling(of_cap, {a, d, c}, {vertex_a, vertex_d, vertex_c}, editor),
              second = append_filling(of_cap, {b, c, d}, {vertex_b, vertex_c, vertex_d}, editor);
  Connectivity& connectivity = editor.connectivity;
  connectivity.join(3 * first, of->beyond_ad);
  connectivity.join(3 * first + 1, 3 * second + 1);
  connectivity.join(3 * first + 2, of->beyond_ca);
  connectivity.join(3 * second, of->beyond_bc);
  connectivity.join(3 * second + 2, of->beyond_db);
  connectivity.set_point_corner(a, 3 * first);
  connectivity.set_point_corner(d, 3 * first + 1);
  connectivity.set_point_corner(c, 3 * first + 2);
  connectivity.set_point_corner(b, 3 * second);
  return std::array<Index, 2>{first, second};
}

}  // namespace sunder::tear
