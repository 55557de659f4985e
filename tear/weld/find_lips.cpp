#include "tear/weld/find_lips.h"

#include <algorithm>
#include <tuple>

namespace sunder::tear {
namespace {

Index count_of_source(const SurfaceEditor& editor) {
  return editor.surface().first_triangle.back();
}

/// The face of the surface that was the whole of an origin.
Index face_of_origin(const TriangleRef& of, const SurfaceEditor& editor) {
  const Index of_source = editor.source().meshes[of.mesh].triangle_count();
  if (of.source_triangle < of_source)
    return editor.surface().first_triangle[of.mesh] + of.source_triangle;
  Index oldest = kNone;
  editor.origins.for_each_appended_part(of.mesh, of.source_triangle,
                                        [&](Index part) { oldest = part; });
  return oldest;
}

bool is_whole_origin(Index face, const SurfaceEditor& editor) {
  return face < count_of_source(editor) || editor.origins.parent(face) == kNone;
}

bool is_of_filling(const TriangleRef& of, const SurfaceEditor& editor) {
  return of.source_triangle >= editor.source().meshes[of.mesh].triangle_count();
}

/// Whether one face belongs to a wall or cap that was made at an edge of the other one.
bool hangs_from(Index face, Index other, const SurfaceEditor& editor) {
  const TriangleRef of = editor.surface().triangle(face), above = editor.surface().triangle(other);
  if (!is_of_filling(of, editor)) return false;
  if (!is_of_filling(above, editor)) return true;
  const Fillings& fillings = editor.fillings;
  const bool is_of_one_group =
      of.mesh == above.mesh && fillings.group(of.mesh, of.source_triangle) ==
                                   fillings.group(above.mesh, above.source_triangle);
  return !is_of_one_group && fillings.serial(of.mesh, of.source_triangle) >
                                 fillings.serial(above.mesh, above.source_triangle);
}

/// The edge of an origin that two places lie on: it begins in the corner of that number. 3: none.
Index edge_of_places(const std::array<double, 3>& from, const std::array<double, 3>& to) {
  for (Index k = 0; k < 3; ++k)
    if (from[(k + 2) % 3] == 0 && to[(k + 2) % 3] == 0) return k;
  return 3;
}

/// The edge of an origin in the whole surface.
struct EdgeOfOrigin {
  Index half_edge, twin;

  /// The corner of the origin from which shares of the edge are counted in both origins is that at
  /// the beginning of the lesser half-edge.
  [[nodiscard]] Index line() const { return std::min(half_edge, twin); }
  [[nodiscard]] Index far_corner() const {
    return half_edge < twin ? Surface::next(half_edge) % 3 : half_edge % 3;
  }
};

/// @return no twin for a border of the source or of a wall.
EdgeOfOrigin edge_of_origin(Index half_edge, Index edge, const SurfaceEditor& editor) {
  const Index face = face_of_origin(editor.surface().triangle(half_edge / 3), editor);
  const Index of_face = 3 * face + edge, twin = editor.log.first_twin(of_face);
  const bool is_edge = twin != kNone && is_whole_origin(twin / 3, editor);
  return {of_face, is_edge ? twin : kNone};
}

void add_lip(Index half_edge, const SurfaceEditor& editor, ScratchVector<Lip>& lips) {
  const Index after = Surface::next(half_edge);
  const auto from = editor.source_barycentric(half_edge), to = editor.source_barycentric(after);
  Lip lip;
  lip.half_edge = half_edge;
  lip.points = {editor.surface().corner_point[half_edge], editor.surface().corner_point[after]};
  if (const Index edge = edge_of_places(from, to); edge < 3) {
    const EdgeOfOrigin on = edge_of_origin(half_edge, edge, editor);
    if (on.twin == kNone) return;
    lip.line = Lip::kOnEdge | on.line();
    lip.from = {from[on.far_corner()], 0};
    lip.to = {to[on.far_corner()], 0};
  } else {
    lip.line = face_of_origin(editor.surface().triangle(half_edge / 3), editor);
    lip.from = {from[1], from[2]};
    lip.to = {to[1], to[2]};
  }
  lips.push_back(lip);
}

}  // namespace

bool is_open(Index half_edge, const SurfaceEditor& editor) {
  const Index twin = editor.surface().twin[half_edge];
  return twin == kNone || hangs_from(twin / 3, half_edge / 3, editor);
}

ScratchVector<Lip> find_lips(const SurfaceEditor& editor) {
  ScratchVector<Lip> lips(&editor.scratch());
  for_each_open_half_edge(editor, [&](Index h) { add_lip(h, editor, lips); });
  std::sort(lips.begin(), lips.end(), [](const Lip& a, const Lip& b) {
    return std::tie(a.line, a.from, a.to, a.half_edge) <
           std::tie(b.line, b.from, b.to, b.half_edge);
  });
  return lips;
}

std::array<double, 3> place_in_origin(const Lip& lip, const std::array<double, 2>& place,
                                      const SurfaceEditor& editor) {
  if (!lip.is_on_edge()) return {1 - place[0] - place[1], place[0], place[1]};
  const Index after = Surface::next(lip.half_edge);
  const Index edge =
      edge_of_places(editor.source_barycentric(lip.half_edge), editor.source_barycentric(after));
  const Index far = edge_of_origin(lip.half_edge, edge, editor).far_corner();
  const Index near = far == edge ? (edge + 1) % 3 : edge;
  std::array<double, 3> barycentric = {0, 0, 0};
  barycentric[far] = place[0];
  barycentric[near] = 1 - place[0];
  return barycentric;
}

}  // namespace sunder::tear
