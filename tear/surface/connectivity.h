#pragma once

#include <span>

#include "tear/surface/edit_log.h"
#include "tear/surface/stage.h"
#include "tear/surface/tear_sides.h"
#include "tear/surface/triangle_origins.h"

namespace sunder::tear {

/// The lowest steps of all edits: corners and twins of the surface, together with the triangles of
/// the meshes. Old triangles must be logged before they change, and there must be room for what is
/// appended.
class Connectivity {
 public:
  Connectivity(Character& character, EditColumns& columns, TriangleOrigins& origins,
               TearSides& sides, Stage& stage)
      : character_(character), columns_(columns), origins_(origins), sides_(sides), stage_(stage) {}

  [[nodiscard]] Surface& surface() { return columns_.surface; }
  [[nodiscard]] const Surface& surface() const { return columns_.surface; }
  /// The vertices of a triangle of the surface.
  [[nodiscard]] const Triangle& vertices_of(Index triangle) const {
    const TriangleRef ref = columns_.surface.triangle(triangle);
    return character_.meshes[ref.mesh].triangles[ref.triangle];
  }
  [[nodiscard]] Index vertex_at(Index corner) const { return vertices_of(corner / 3)[corner % 3]; }

  void set_corner(Index corner, Index point, Index vertex) {
    columns_.surface.corner_point[corner] = point;
    const TriangleRef ref = columns_.surface.triangle(corner / 3);
    character_.meshes[ref.mesh].triangles[ref.triangle][corner % 3] = vertex;
  }
  void set_vertices(Index triangle, const Triangle& vertices) {
    const TriangleRef ref = columns_.surface.triangle(triangle);
    character_.meshes[ref.mesh].triangles[ref.triangle] = vertices;
  }
  /// Joins two half-edges as twins, or makes one a border if `b` is kNone.
  void join(Index a, Index b) {
    columns_.surface.twin[a] = b;
    if (b != kNone) columns_.surface.twin[b] = a;
  }
  /// Sets the corner by which a point is found (Surface::point_corner).
  void set_point_corner(Index point, Index corner) {
    columns_.surface.point_corner[point] = corner;
  }

  /// A point without corners, with a tear side of its own.
  Index append_point() {
    columns_.surface.point_corner.push_back(kNone);
    columns_.surface.appended_side.push_back(sides_.take_next());
    return columns_.surface.point_count() - 1;
  }
  /// Remembers the points of an edge that was welded.
  void append_scar(const std::array<Index, 2>& points) { columns_.scars.push_back(points); }
  [[nodiscard]] std::span<const std::array<Index, 2>> scars() const { return columns_.scars; }
  void append_thread(const SutureThread& thread) { columns_.threads.push_back(thread); }
  [[nodiscard]] std::span<const SutureThread> threads() const { return columns_.threads; }
  /// A triangle that is split from `like`. It has no twins.
  Index append_part(Index like, const std::array<Index, 3>& points, const Triangle& vertices);
  /// The triangle of a filling. It has no twins.
  Index append_filling(const TriangleRef& origin, Index submesh, const std::array<Index, 3>& points,
                       const Triangle& vertices);

 private:
  Index append_triangle(const TriangleRef& ref, Index submesh, const std::array<Index, 3>& points,
                        const Triangle& vertices);

  Character& character_;
  EditColumns& columns_;
  TriangleOrigins& origins_;
  TearSides& sides_;
  Stage& stage_;
};

}  // namespace sunder::tear
