#pragma once

#include <sunder/core/math.h>

#include <array>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// A Delaunay triangulation of points in the plane with forced edges, to which points can be added
/// inside the forced edges. Every decision is exact.
///
/// Half-edge h of triangle h / 3 leaves origin_[h]. The convex hull is closed by triangles that
/// share a ghost point at infinity, so every half-edge has a twin.
class ConstrainedDelaunay {
 public:
  using Corners = std::array<Index, 3>;

  /// @param points  in exact_range().
  /// @param spare   number of points that insert() may add.
  /// @param memory  for all data; it must outlive the triangulation.
  /// @return nullopt if two points coincide or all are collinear.
  ///
  /// Incremental insertion (Bowyer, Watson) in insertion_order(): expected O(n log n).
  static std::optional<ConstrainedDelaunay> of(std::span<const Vec2d> points, std::size_t spare,
                                               std::pmr::memory_resource& memory);

  /// Forces the segment between two points to be an edge.
  /// @return false, with nothing changed, if a third point lies on the segment or an edge fixed
  /// before crosses it.
  [[nodiscard]] bool fix_edge(Index a, Index b);

  /// Finds the triangles inside the closed loops of fixed edges, by the even-odd rule. Constrained
  /// Delaunay: no unfixed edge has the far corner of one side inside the circle of the other.
  /// @return false if there are none, or if they are not connected across unfixed edges. Otherwise
  /// no more edges may be fixed.
  [[nodiscard]] bool find_inside();

  /// An edge around the triangles that a new point replaces; they lie on its left.
  struct CavityEdge {
    Index from, to;
    Index outer;  ///< Half-edge on its other side.
    bool is_fixed;
  };
  /// Finds the triangles that a point would replace.
  /// @param from  an inside triangle near it.
  /// @return the edges around them. None if the point cannot be inserted: it is not visible from
  /// `from`, or on a fixed edge, or coincides with another one.
  [[nodiscard]] std::span<const CavityEdge> find_cavity(const Vec2d& point, Index from);
  /// Inserts the point of find_cavity(). @return its new triangles.
  std::span<const Index> insert(const Vec2d& point);
  /// Moves each point from `first` on, which were inserted, to the mean of its neighbours, if that
  /// makes the worst of its triangles better; then the triangulation is made Delaunay again.
  void smooth(Index first);

  [[nodiscard]] std::span<const Vec2d> points() const { return points_; }
  [[nodiscard]] Index triangle_count() const { return static_cast<Index>(origin_.size() / 3); }
  [[nodiscard]] bool is_inside(Index triangle) const { return inside_[triangle] == 1; }
  /// The other half-edge between the ends of a half-edge. The half-edges of triangle t are 3 t + k,
  /// from its corner k to the next one.
  [[nodiscard]] Index twin(Index half_edge) const { return twin_[half_edge]; }
  /// Counter-clockwise.
  [[nodiscard]] Corners corners(Index triangle) const {
    return {origin_[3 * triangle], origin_[3 * triangle + 1], origin_[3 * triangle + 2]};
  }

 private:
  static constexpr Index kGhost = kNone;
  static constexpr char kUnknown = 2;

  ConstrainedDelaunay(std::span<const Vec2d> points, std::size_t spare,
                      std::pmr::memory_resource& memory);
  [[nodiscard]] bool insert_all(std::span<const Index> order);
  void start(Index a, Index b, Index c);
  /// The triangle that contains a point, or a ghost triangle whose edge sees it from outside; kNone
  /// if the point coincides with an earlier one.
  [[nodiscard]] Index locate(Index point) const;
  /// The inside triangle that contains a point; kNone if a fixed edge is in the way.
  [[nodiscard]] Index locate_inside(const Vec2d& point, Index from) const;
  [[nodiscard]] bool in_conflict(Index triangle, const Vec2d& point) const;
  void grow_cavity(Index found, const Vec2d& point);
  [[nodiscard]] bool is_star_around(const Vec2d& point);
  void fill_cavity(Index point);
  void refill(Index a, Index b);
  void flip(Index half_edge);
  void make_delaunay();
  [[nodiscard]] bool is_one_piece();

  [[nodiscard]] Index end(Index half_edge) const { return origin_[Surface::next(half_edge)]; }
  [[nodiscard]] Index apex(Index half_edge) const { return origin_[Surface::previous(half_edge)]; }
  [[nodiscard]] Index& spoke(Index point) { return spoke_[point == kGhost ? 0 : point + 1]; }
  /// The finite half-edge of a ghost triangle; kNone for other triangles.
  [[nodiscard]] Index hull_edge(Index triangle) const;
  void set_triangle(Index triangle, const Corners& corners);
  void join(Index half_edge, Index other) { twin_[half_edge] = other, twin_[other] = half_edge; }

  /// The triangles that a segment crosses, and what replaces them.
  struct Crossing {
    explicit Crossing(std::pmr::memory_resource& memory);

    struct Link {
      Index low, high, half_edge;  ///< No half-edge: the edge is fixed.
    };
    std::pmr::vector<Index> crossed, rights, lefts, stack;
    std::pmr::vector<Corners> filling;
    std::pmr::vector<Link> links;
    bool is_used = false;  ///< Whether any triangle was replaced.
  };

  std::pmr::vector<Vec2d> points_;
  std::pmr::vector<Index> origin_;
  std::pmr::vector<Index> twin_;
  std::pmr::vector<char> fixed_;     ///< By half-edge.
  std::pmr::vector<char> inside_;    ///< Per triangle: 1 inside, 0 outside, kUnknown.
  std::pmr::vector<Index> visit_;    ///< Per triangle: the last cavity that contained it.
  std::pmr::vector<Index> leaving_;  ///< Per point a half-edge that leaves it.
  std::pmr::vector<Index> spoke_;    ///< Scratch memory, the ghost first, then per point.
  std::pmr::vector<Index> cavity_;   ///< Triangles of the last cavity, and of what replaced it.
  std::pmr::vector<CavityEdge> rim_;
  Crossing crossing_;
  Index cavity_number_ = 0;  ///< Number of cavities so far.
  Index last_ = 0;           ///< The triangle at which locate() starts.
};

}  // namespace sunder::tear
