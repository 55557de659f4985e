#pragma once

#include <sunder/core/character.h>

#include <algorithm>
#include <array>
#include <vector>

namespace sunder::tear {

/// The place of a surface triangle in the character, and the origin that it is a part of: a
/// triangle of the source or a filling.
struct TriangleRef {
  Index mesh = 0;
  Index triangle = 0;  ///< In the mesh as it is now.
  Index source_triangle =
      0;  ///< Origin: in the mesh as it was loaded, or beyond its triangles a filling.
};

/// Connectivity of a character's surface on points, all meshes together. The source takes 24 bytes
/// per triangle and 4 per point.
///
/// Triangle t has corners 3t, 3t+1, 3t+2. A corner also names the half-edge that leaves it, towards
/// the next corner. Each point has one fan: its corners are reached from one another across edges.
/// Where a surface touches itself in a single point, there are two points.
struct Surface {
  std::vector<Index> corner_point;  ///< 3 per triangle.
  std::vector<Index> twin;          ///< 3 per triangle: the opposite half-edge, kNone at a border.
  std::vector<Index> first_triangle;  ///< Per mesh, the first of its source triangles; then the
                                      ///< number of all source triangles.
  std::vector<TriangleRef> appended;  ///< The triangles after those of the source.
  std::vector<Index> point_corner;  ///< Per point, one of its corners; kNone for a point that only
                                    ///< degenerate triangles use.
  std::vector<Index>
      source_side;  ///< Per point of the source, its value of _TEARSIDE; empty if all are 0.
  std::vector<Index> appended_side;  ///< One per point that the source does not have.
  std::vector<std::vector<bool>>
      is_shared_vertex;  ///< Per mesh: which source vertices are used by more than one fan.
  /// Per mesh, the largest magnitude of a bind coordinate of the source.
  std::vector<float> largest_coordinate;
  /// Of the source, see find_cracks(): pairs (half-edge, half-edge across the crack), ascending.
  std::vector<std::array<Index, 2>> cracks;
  Index non_manifold_edges =
      0;  ///< At build: edges with more than two faces, or with two that disagree in winding.
  Index non_manifold_half_edges = 0;  ///< At build: half-edges left unjoined for that reason.

  [[nodiscard]] Index triangle_count() const {
    return first_triangle.back() + static_cast<Index>(appended.size());
  }
  [[nodiscard]] Index point_count() const { return static_cast<Index>(point_corner.size()); }
  [[nodiscard]] Index source_point_count() const {
    return point_count() - static_cast<Index>(appended_side.size());
  }

  [[nodiscard]] TriangleRef triangle(Index t) const {
    if (t >= first_triangle.back()) return appended[t - first_triangle.back()];
    Index mesh = 0;
    if (first_triangle.size() > 2)
      mesh = static_cast<Index>(std::upper_bound(first_triangle.begin(), first_triangle.end(), t) -
                                first_triangle.begin()) -
             1;
    return {mesh, t - first_triangle[mesh], t - first_triangle[mesh]};
  }
  /// Value of _TEARSIDE of a point.
  [[nodiscard]] Index side(Index point) const {
    if (point >= source_point_count()) return appended_side[point - source_point_count()];
    return source_side.empty() ? 0 : source_side[point];
  }

  /// The half-edge across a crack from a half-edge of the source; kNone if there is no crack.
  [[nodiscard]] Index across_crack(Index half_edge) const {
    const auto at = std::lower_bound(cracks.begin(), cracks.end(), std::array{half_edge, Index{0}});
    return at != cracks.end() && (*at)[0] == half_edge ? (*at)[1] : kNone;
  }

  static Index next(Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  static Index previous(Index corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

  /// The corner of the same point in the face across its incoming edge (counter-clockwise), or
  /// across its outgoing edge (clockwise).
  [[nodiscard]] Index rotate_ccw(Index corner) const { return twin[previous(corner)]; }
  [[nodiscard]] Index rotate_cw(Index corner) const {
    return twin[corner] == kNone ? kNone : next(twin[corner]);
  }

  /// The corner of a fan from which rotate_ccw() reaches all others: the clockwise end of an open
  /// fan, or `corner` itself in a closed one.
  [[nodiscard]] Index first_of_fan(Index corner) const {
    Index first = corner;
    for (Index c = rotate_cw(corner); c != kNone && c != corner; c = rotate_cw(c)) first = c;
    return rotate_cw(first) == kNone ? first : corner;
  }

  /// Calls visit(corner) for every corner of the fan that holds `corner`, counter-clockwise.
  template <class Visit>
  void for_each_in_fan(Index corner, Visit visit) const {
    const Index first = first_of_fan(corner);
    Index c = first;
    do {
      const Index following = rotate_ccw(c);
      visit(c);
      c = following;
    } while (c != kNone && c != first);
  }

  [[nodiscard]] bool is_on_border(Index point) const {
    return rotate_cw(first_of_fan(point_corner[point])) == kNone;
  }

  /// The half-edge from one point to another, or kNone.
  [[nodiscard]] SUNDER_API Index find_half_edge(Index from, Index to) const;
  [[nodiscard]] bool has_repeated_point(Index triangle) const {
    const Index* p = &corner_point[3 * triangle];
    return p[0] == p[1] || p[1] == p[2] || p[2] == p[0];
  }
};

/// Joins vertices into points and triangles across edges. Edges with more than two faces, and edges
/// whose two faces disagree in winding, stay unjoined unless the vertices themselves tell which
/// faces belong together. O(vertices + triangles), deterministic.
[[nodiscard]] SUNDER_API Surface build_surface(const Character& character);

}  // namespace sunder::tear
