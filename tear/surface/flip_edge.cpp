#include "tear/surface/flip_edge.h"

#include <algorithm>
#include <cmath>

#include "tear/geometry/tolerances.h"
#include "tear/surface/face_split.h"

namespace sunder::tear {

namespace {

/// The corners of two faces (a, b, c), (b, a, d) at an edge: half-edges that leave the points.
struct Quadrilateral {
  Index ab, bc, ca, ba, ad, db;
};

bool are_of_one_origin(const Quadrilateral& at, const SurfaceEditor& editor) {
  const TriangleRef f = editor.surface().triangle(at.ab / 3),
                    g = editor.surface().triangle(at.ba / 3);
  return f.mesh == g.mesh && f.source_triangle == g.source_triangle &&
         editor.vertex_at(at.ab) == editor.vertex_at(at.ad) &&
         editor.vertex_at(at.bc) == editor.vertex_at(at.ba);
}

/// Whether both new faces cover a part of the origin, and of the bind surface as its rounded
/// positions have it.
bool leaves_sound_faces(const Quadrilateral& at, const SurfaceEditor& editor) {
  const auto place_a = editor.source_barycentric(at.ab), place_b = editor.source_barycentric(at.bc),
             place_c = editor.source_barycentric(at.ca), place_d = editor.source_barycentric(at.db);
  const double whole =
      covered_part(place_a, place_b, place_c) + covered_part(place_b, place_a, place_d);
  const double least_part = std::max(kLeastOriginAreas, kLeastFaceAreas * whole);
  if (!(covered_part(place_a, place_d, place_c) > least_part) ||
      !(covered_part(place_b, place_c, place_d) > least_part))
    return false;
  const TriangleRef face = editor.surface().triangle(at.ab / 3);
  const Index a = editor.vertex_at(at.ab), b = editor.vertex_at(at.bc), c = editor.vertex_at(at.ca),
              d = editor.vertex_at(at.db);
  const auto normal_of = [&](const Triangle& triangle) {
    return normal(editor, face.mesh, triangle);
  };
  const Place of_origin =
      normal_of(editor.fillings.origin_triangle(face.mesh, face.source_triangle));
  const Place before = normal_of({a, b, c});
  const double least = kLeastFaceAreas * std::sqrt(dot(before, before) * dot(of_origin, of_origin));
  return dot(normal_of({a, d, c}), of_origin) > least &&
         dot(normal_of({b, c, d}), of_origin) > least;
}

void flip(const Quadrilateral& at, SurfaceEditor& editor) {
  Connectivity& connectivity = editor.connectivity;
  const Surface& surface = editor.surface();
  const Index a = surface.corner_point[at.ab], b = surface.corner_point[at.bc];
  const Index c = surface.corner_point[at.ca], d = surface.corner_point[at.db];
  const Index twin_bc = surface.twin[at.bc], twin_ad = surface.twin[at.ad];
  editor.room.make_for_changes(4);
  editor.log.keep(at.ab / 3);
  editor.log.keep(at.ba / 3);
  if (twin_bc != kNone) editor.log.keep(twin_bc / 3);
  if (twin_ad != kNone) editor.log.keep(twin_ad / 3);
  const Index vertex_c = editor.vertex_at(at.ca), vertex_d = editor.vertex_at(at.db);
  connectivity.set_corner(at.bc, d, vertex_d);
  connectivity.set_corner(at.ad, c, vertex_c);
  editor.opened_edges.move(at.bc, at.ba);
  editor.opened_edges.move(at.ad, at.ab);
  connectivity.join(at.ab, twin_ad);
  connectivity.join(at.ba, twin_bc);
  connectivity.join(at.bc, at.ad);
  connectivity.set_point_corner(a, at.ab);
  connectivity.set_point_corner(b, at.ba);
  connectivity.set_point_corner(c, at.ca);
  connectivity.set_point_corner(d, at.db);
}

}  // namespace

bool flip_edge(Index half_edge, SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  const Index twin = surface.twin[half_edge];
  if (twin == kNone) return false;
  const Quadrilateral at = {half_edge, Surface::next(half_edge), Surface::previous(half_edge),
                            twin,      Surface::next(twin),      Surface::previous(twin)};
  if (!are_of_one_origin(at, editor)) return false;
  const Index c = surface.corner_point[at.ca], d = surface.corner_point[at.db];
  if (c == d || surface.find_half_edge(c, d) != kNone || surface.find_half_edge(d, c) != kNone)
    return false;
  if (!leaves_sound_faces(at, editor)) return false;
  flip(at, editor);
  return true;
}

}  // namespace sunder::tear
