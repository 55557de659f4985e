#pragma once

#include <sunder/core/character.h>
#include <sunder/tear/change_record.h>
#include <sunder/weights/interpolate.h>

#include <array>
#include <vector>

#include "tear/surface.h"

namespace sunder::tear {

/// Refines and opens the surface, and with it the meshes: the only place that changes either. Every change is logged, so that it
/// can be taken back to any earlier mark, bit for bit.
class SurfaceEditor {
 public:
  SurfaceEditor(const Character& source, Character& character);

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const Character& character() const { return character_; }
  [[nodiscard]] Index vertex_at(Index corner) const {
    const TriangleRef& ref = surface_.triangles[corner / 3];
    return character_.meshes[ref.mesh].triangles[ref.triangle][corner % 3];
  }
  /// Birth of a vertex that is not of the source.
  [[nodiscard]] const Birth& birth(Index mesh, Index vertex) const {
    return births_[mesh][vertex - source_.meshes[mesh].vertex_count()];
  }

  /// The surface's number of a mesh's triangle. Appended triangles are numbered in the order in which they were made, over all
  /// meshes.
  [[nodiscard]] Index surface_triangle(Index mesh, Index triangle) const {
    const Index source_count = source_.meshes[mesh].triangle_count();
    return triangle < source_count ? first_triangle_[mesh] + triangle : appended_triangles_[mesh][triangle - source_count];
  }

  /// Puts one new point on an edge, `fraction` of the way along the half-edge, and splits the faces at both sides of it.
  /// @return the point; kNone where a face would have lost its area or turned over, and nothing was changed.
  [[nodiscard]] Index split_edge(Index half_edge, double fraction);
  /// Puts a new point into a triangle and splits it in three. `barycentric`: of its corners, all > 0.
  /// @return as split_edge().
  [[nodiscard]] Index split_triangle(Index triangle, const std::array<double, 3>& barycentric);
  /// Disconnects the faces at both sides of a half-edge.
  void cut_edge(Index half_edge);
  /// Gives the fan that holds `corner` a point of its own, with side `side`. Vertices that faces of other fans use are duplicated.
  /// @param remaining  a corner of each other fan that this point has.
  Index separate_fan(Index corner, Index side, const std::vector<Index>& remaining);

  /// A state to come back to.
  struct Mark {
    Index points = 0;
    Index triangles = 0;
    std::size_t log_length = 0;
    std::vector<std::array<Index, 2>> mesh_sizes;  ///< Vertices and triangles of each mesh.
  };
  [[nodiscard]] Mark mark() const;
  void roll_back(const Mark& to);

  /// Ends an operation that began at `begin`: writes _TEARSIDE of what it changed, fills in `change` but for its lips, empties the
  /// log.
  void commit(const Mark& begin, ChangeRecord& change);

 private:
  /// A triangle as it was before a change, and the corner that its points were known by.
  struct LogEntry {
    Index triangle;
    std::array<Index, 3> points;
    std::array<Index, 3> twins;
    std::array<Index, 3> point_corners;
    Triangle vertices;
  };

  void log_triangle(Index triangle);
  void set_corner(Index corner, Index point, Index vertex);
  void join(Index a, Index b);
  Index append_triangle(Index like, const std::array<Index, 3>& points, const Triangle& vertices);
  Index append_point(Index side);
  Index append_vertex(Index mesh, const Birth& birth);
  void remove_newest_vertex(Index mesh);
  [[nodiscard]] Triangle vertices_of(Index triangle) const;
  /// Barycentric coordinates of a corner in the source triangle.
  [[nodiscard]] std::array<double, 3> source_barycentric(Index corner) const;
  [[nodiscard]] Birth birth_between(Index triangle, const std::array<double, 3>& barycentric) const;
  /// Whether replacing one corner of a triangle by a vertex keeps its winding.
  [[nodiscard]] bool keeps_winding(Index corner, Index vertex) const;

  const Character& source_;
  Character& character_;
  Surface surface_;
  std::vector<std::vector<Birth>> births_;  ///< Of each mesh: its vertices beyond the source's.
  std::vector<Index> first_triangle_;       ///< Of each mesh, in the surface.
  std::vector<std::vector<Index>>
      appended_triangles_;  ///< Of each mesh: the surface's numbers of its triangles beyond the source's.
  std::vector<LogEntry> log_;
};

}  // namespace sunder::tear
