#pragma once

#include <sunder/core/math.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// A Delaunay triangulation of points in the plane with forced edges. Every decision is exact.
///
/// Half-edge h of triangle h / 3 leaves origin_[h]. The convex hull is closed by triangles that
/// share a ghost point at infinity, so every half-edge has a twin.
class ConstrainedDelaunay {
 public:
  /// @param points  in exact_range(); they must outlive the triangulation.
  /// @return nullopt if two points coincide or all are collinear.
  ///
  /// Incremental insertion (Bowyer, Watson) in insertion_order(): expected O(n log n).
  static std::optional<ConstrainedDelaunay> of(std::span<const Vec2d> points);

  /// Forces the segment between two points to be an edge.
  /// @return false, with nothing changed, if a third point lies on the segment or an edge fixed
  /// before crosses it.
  [[nodiscard]] bool fix_edge(Index a, Index b);

  /// The triangles inside the closed loops of fixed edges, by the even-odd rule, counter-clockwise.
  /// Constrained Delaunay: no unfixed edge has the far corner of one side inside the circle of the
  /// other.
  /// @return empty if they are not connected across unfixed edges.
  [[nodiscard]] std::vector<std::array<Index, 3>> inside() &&;

 private:
  static constexpr Index kGhost = kNone;

  explicit ConstrainedDelaunay(std::span<const Vec2d> points) : points_(points) {}
  void start(Index a, Index b, Index c);
  /// The triangle that contains a point, or a ghost triangle whose edge sees it from outside; kNone
  /// if the point coincides with an earlier one.
  [[nodiscard]] Index locate(Index point) const;
  [[nodiscard]] bool in_conflict(Index triangle, Index point) const;
  [[nodiscard]] bool insert(Index point);
  void refill(const std::vector<Index>& crossed, const std::vector<std::array<Index, 3>>& filling,
              Index a, Index b);
  void flip(Index half_edge);
  void make_delaunay(const std::vector<char>& is_inside);

  [[nodiscard]] Index end(Index half_edge) const { return origin_[Surface::next(half_edge)]; }
  [[nodiscard]] Index apex(Index half_edge) const { return origin_[Surface::previous(half_edge)]; }
  /// The finite half-edge of a ghost triangle; kNone for other triangles.
  [[nodiscard]] Index hull_edge(Index triangle) const;
  void set_triangle(Index triangle, const std::array<Index, 3>& corners);
  void join(Index half_edge, Index other) { twin_[half_edge] = other, twin_[other] = half_edge; }

  std::span<const Vec2d> points_;
  std::vector<Index> origin_;
  std::vector<Index> twin_;
  std::vector<char> fixed_;     ///< By half-edge.
  std::vector<Index> leaving_;  ///< Per point a half-edge that leaves it.
  std::vector<Index> visit_;    ///< Per triangle: the last cavity that contained it.
  std::vector<Index> spoke_;    ///< Per point, the ghost last: scratch memory of insert().
  Index cavity_ = 0;            ///< Number of cavities so far.
  Index last_ = 0;              ///< The triangle at which locate() starts.
};

}  // namespace sunder::tear
