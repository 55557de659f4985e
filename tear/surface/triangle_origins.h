#pragma once

#include "core/internal/prefetch.h"
#include "tear/surface/edit_columns.h"

namespace sunder::tear {

/// The origins of triangles: each face is a part of an origin, which is a triangle of the source or
/// a filling. An appended triangle was split from another one, its parent.
class TriangleOrigins {
 public:
  TriangleOrigins(const Character& source, const Character& character, EditColumns& columns)
      : source_(source), character_(character), columns_(columns) {}

  /// Index in the surface of a triangle of a mesh. Appended triangles are numbered in the order in
  /// which they were made, over all meshes.
  [[nodiscard]] Index surface_triangle(Index mesh, Index triangle) const {
    const Index source_count = source_.meshes[mesh].triangle_count();
    if (triangle < source_count) return surface().first_triangle[mesh] + triangle;
    return columns_.meshes[mesh].surface_triangles[triangle - source_count];
  }
  /// Calls visit(triangle of the surface) for each remaining face that is a part of an origin.
  template <class Visit>
  void for_each_part(Index mesh, Index origin, Visit visit) const {
    const auto visit_face = [&](Index triangle) {
      if (!surface().has_repeated_point(triangle)) visit(triangle);
    };
    if (origin < source_.meshes[mesh].triangle_count())
      visit_face(surface().first_triangle[mesh] + origin);
    for_each_appended_part(mesh, origin, visit_face);
  }
  /// The same for each triangle that was appended as a part of an origin, also where nothing of it
  /// remains.
  template <class Visit>
  void for_each_appended_part(Index mesh, Index origin, Visit visit) const {
    for (Index part = columns_.meshes[mesh].newest_part[origin]; part != kNone;
         part = columns_.older_part[part - source_triangles()])
      visit(part);
  }
  /// Whether a face is a triangle of the source that nothing has changed.
  [[nodiscard]] bool is_whole(Index triangle) const {
    if (triangle >= source_triangles()) return false;
    const TriangleRef ref = surface().triangle(triangle);
    return is_same(character_.meshes[ref.mesh].triangles[ref.triangle],
                   source_.meshes[ref.mesh].triangles[ref.triangle]);
  }
  /// Whether the faces on both sides of an edge are parts of one origin.
  [[nodiscard]] bool is_inner_edge(Index half_edge) const {
    const Index twin = surface().twin[half_edge];
    // Of two triangles with the same origin, at least one was appended.
    if (twin == kNone || std::max(half_edge, twin) / 3 < source_triangles()) return false;
    const TriangleRef here = surface().triangle(half_edge / 3),
                      there = surface().triangle(twin / 3);
    return here.mesh == there.mesh && here.source_triangle == there.source_triangle;
  }
  /// The triangle that an appended one was split from; kNone for fillings.
  [[nodiscard]] Index parent(Index triangle) const {
    const Index parent = columns_.parents[triangle - source_triangles()];
    return parent == kNone ? kNone : parent & ~kSettled;
  }
  /// Whether a face was made by a split along the better diagonal, and not split again since. For a
  /// triangle of the source: whether its newest part was.
  [[nodiscard]] bool is_settled(Index triangle) const {
    if (triangle < source_triangles()) {
      const TriangleRef ref = surface().triangle(triangle);
      triangle = columns_.meshes[ref.mesh].newest_part[ref.source_triangle];
      if (triangle == kNone) return false;
    }
    const Index parent = columns_.parents[triangle - source_triangles()];
    return parent != kNone && (parent & kSettled) != 0;
  }
  /// Marks the newest triangle as settled.
  void settle_newest() { columns_.parents.back() |= kSettled; }

  /// Links appended triangles into the lists of their origins' parts. There must be room.
  void link_new_parts() {
    for (Index t = source_triangles() + static_cast<Index>(columns_.older_part.size());
         t < surface().triangle_count(); ++t) {
      const TriangleRef ref = surface().triangle(t);
      Index& newest = columns_.meshes[ref.mesh].newest_part[ref.source_triangle];
      columns_.older_part.push_back(newest);
      newest = t;
    }
  }
  /// Removes the triangles from `first` on from the lists; to be called before their rows are
  /// removed.
  void unlink_parts_from(Index first) {
    for (std::size_t i = columns_.older_part.size(); source_triangles() + i > first; --i) {
      const TriangleRef ref = surface().appended[i - 1];
      columns_.meshes[ref.mesh].newest_part[ref.source_triangle] = columns_.older_part[i - 1];
    }
  }
  void fetch_newest_part(const TriangleRef& of) const {
    prefetch(&columns_.meshes[of.mesh].newest_part[of.triangle]);
  }

 private:
  static constexpr Index kSettled =
      Index{1} << 31;  // combined with a triangle's index, which is less than 2^30

  [[nodiscard]] const Surface& surface() const { return columns_.surface; }
  [[nodiscard]] Index source_triangles() const { return columns_.surface.first_triangle.back(); }

  const Character& source_;
  const Character& character_;
  EditColumns& columns_;
};

}  // namespace sunder::tear
