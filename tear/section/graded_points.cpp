#include "tear/section/graded_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/internal/ordered.h"
#include "tear/section/exact_predicates.h"

namespace sunder::tear {
namespace {

/// The size at the rim by the length of its edges. A larger one makes fewer triangles with smaller
/// angles: their edges on the rim stay.
constexpr double kSizePerEdge = 0.9;
/// The growth of the size by the distance from the rim.
constexpr double kGrowth = 0.5;
/// The decline of a long edge's size along the rim, by the distance.
constexpr double kDecline = 0.5;
/// A point with an edge of the rim in its sight at a larger angle than that of this cosine is too
/// close to it.
constexpr double kLeastSightCosine = -0.5;
constexpr int kSmoothings = 2;
/// A triangle is a sliver if its shortest side is shorter than this part of the others.
constexpr double kSliverSide = 0.1;
/// The distance of the point in front of the short side of a sliver, by the length of that side.
constexpr double kSliverDepth = 5;

struct Circle {
  Vec2d centre;
  double radius;
};

/// The circle through three points. @return nullopt if they are too close to a line.
std::optional<Circle> circle_of(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  const Vec2d ab = b - a, ac = c - a;
  const double doubled = 2 * (ab.x() * ac.y() - ab.y() * ac.x());
  if (!(doubled > 0)) return std::nullopt;
  const double ab2 = squared_norm(ab), ac2 = squared_norm(ac);
  const Vec2d offset((ac.y() * ab2 - ab.y() * ac2) / doubled,
                     (ab.x() * ac2 - ac.x() * ab2) / doubled);
  const auto centre = exact_range(a + offset);
  if (!centre) return std::nullopt;
  return Circle{*centre, norm(offset)};
}

bool is_close(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
  const Vec2d to_a = a - p, to_b = b - p;
  return dot(to_a, to_b) < kLeastSightCosine * norm(to_a) * norm(to_b);
}

/// The sizes at the points of the rim.
void find_sizes(std::span<const Vec2d> points, std::span<const Index> loop_ends,
                std::span<double> sizes) {
  Index first = 0;
  for (const Index end : loop_ends) {
    const auto after = [&](Index p) { return p + 1 == end ? first : p + 1; };
    const auto length = [&](Index p) { return norm(points[after(p)] - points[p]); };
    for (Index p = first; p < end; ++p) {
      sizes[p] = std::max(sizes[p], kSizePerEdge * length(p));
      sizes[after(p)] = std::max(sizes[after(p)], kSizePerEdge * length(p));
    }
    const auto decline = [&](Index from, Index to, double distance) {
      sizes[to] = std::max(sizes[to], sizes[from] - kSizePerEdge * kDecline * distance);
    };
    for (int turn = 0; turn < 2; ++turn) {  // the second starts with what the first ended with
      for (Index p = first; p < end; ++p) decline(p, after(p), length(p));
      for (Index p = end; p-- > first;) decline(after(p), p, length(p));
    }
    first = end;
  }
}

/// The size at the centre of a circle around a triangle, which is equally far from its corners.
double size_at_centre(const ConstrainedDelaunay::Corners& corners, double radius,
                      std::span<const double> sizes) {
  return std::min({sizes[corners[0]], sizes[corners[1]], sizes[corners[2]]}) + kGrowth * radius;
}

/// The edges of the rim that are short and alone: a few edges away there is a long one on both
/// sides, as where a plane passes a vertex. Where a whole part of a rim has short edges, no points
/// are asked for in front of them.
class LoneEdges {
 public:
  LoneEdges(std::span<const Vec2d> points, std::span<const Index> loop_ends,
            std::pmr::memory_resource& memory)
      : after_(points.size(), 0, &memory), is_lone_(points.size(), 0, &memory) {
    std::pmr::vector<double> squared_lengths(points.size(), 0.0, &memory);
    Index first = 0;
    for (const Index end : loop_ends) {
      for (Index p = first; p < end; ++p) {
        after_[p] = p + 1 == end ? first : p + 1;
        squared_lengths[p] = squared_norm(Vec2d(points[after_[p]] - points[p]));
      }
      for (Index p = first; p < end; ++p) is_lone_[p] = is_lone(p, first, end, squared_lengths);
      first = end;
    }
  }

  /// @param a, b  ends of an edge of the rim.
  [[nodiscard]] bool has(Index a, Index b) const { return is_lone_[after_[a] == b ? a : b] != 0; }

 private:
  static char is_lone(Index p, Index first, Index end, std::span<const double> squared_lengths) {
    constexpr Index kFew = 3;
    double longest_before = 0, longest_after = 0;
    for (Index i = 1, before = p, after = p; i <= std::min(kFew, end - first - 1); ++i) {
      before = before == first ? end - 1 : before - 1;
      after = after + 1 == end ? first : after + 1;
      longest_before = std::max(longest_before, squared_lengths[before]);
      longest_after = std::max(longest_after, squared_lengths[after]);
    }
    return squared_lengths[p] < kSliverSide * kSliverSide * std::min(longest_before, longest_after)
               ? 1
               : 0;
  }

  std::pmr::vector<Index> after_;   ///< Per point of the rim the next one.
  std::pmr::vector<char> is_lone_;  ///< Per edge of the rim, by its first point.
};

/// The point to insert in a sliver, in front of its shortest side and close to it, so that the
/// triangles there grow by steps (Uengoer 2004). @return nullopt if the triangle is none, or if the
/// side joins points of the rim and is no lone edge of it.
std::optional<Vec2d> point_in_sliver(const ConstrainedDelaunay::Corners& corners,
                                     std::span<const Vec2d> points, Index rim_count,
                                     const LoneEdges& lone_edges) {
  std::array<double, 3> squared_sides;
  for (std::size_t k = 0; k < 3; ++k)
    squared_sides[k] = squared_norm(Vec2d(points[corners[(k + 1) % 3]] - points[corners[k]]));
  const auto k = static_cast<std::size_t>(
      std::min_element(squared_sides.begin(), squared_sides.end()) - squared_sides.begin());
  const double next = std::min(squared_sides[(k + 1) % 3], squared_sides[(k + 2) % 3]);
  if (!(squared_sides[k] < kSliverSide * kSliverSide * next)) return std::nullopt;
  const Index a = corners[k], b = corners[(k + 1) % 3];
  if (std::max(a, b) < rim_count && !lone_edges.has(a, b)) return std::nullopt;
  const Vec2d along = points[b] - points[a];
  return exact_range(0.5 * (points[a] + points[b]) + kSliverDepth * Vec2d(-along.y(), along.x()));
}

/// The point to insert in a triangle: the centre of its circle if that is large for its place, or
/// one against slivers. @return nullopt if the triangle may stay.
std::optional<Vec2d> point_in(const ConstrainedDelaunay::Corners& corners,
                              std::span<const Vec2d> points, std::span<const double> sizes,
                              Index rim_count, const LoneEdges& lone_edges) {
  const auto circle = circle_of(points[corners[0]], points[corners[1]], points[corners[2]]);
  if (circle && circle->radius > size_at_centre(corners, circle->radius, sizes))
    return circle->centre;
  return point_in_sliver(corners, points, rim_count, lone_edges);
}

/// The size at a point whose cavity was found. @return nullopt if the point is too close to the
/// rim.
std::optional<double> size_in_cavity(const Vec2d& p,
                                     std::span<const ConstrainedDelaunay::CavityEdge> edges,
                                     std::span<const Vec2d> points, std::span<const double> sizes) {
  double size = std::numeric_limits<double>::infinity();
  for (const auto& edge : edges) {
    if (edge.is_fixed && is_close(p, points[edge.from], points[edge.to])) return std::nullopt;
    size = std::min(size, sizes[edge.from] + kGrowth * norm(points[edge.from] - p));
  }
  return size;
}

}  // namespace

void add_graded_points(std::span<const Index> loop_ends, ConstrainedDelaunay& triangulation,
                       std::pmr::memory_resource& memory) {
  const auto rim_count = static_cast<Index>(triangulation.points().size());
  const std::size_t most = rim_count + most_graded_points(rim_count);
  std::pmr::vector<double> sizes(&memory);
  sizes.reserve(most);
  sizes.assign(rim_count, 0.0);
  find_sizes(triangulation.points(), loop_ends, sizes);

  const LoneEdges lone_edges(triangulation.points(), loop_ends, memory);

  std::pmr::vector<Index> queue(&memory);
  for (Index t = 0; t < triangulation.triangle_count(); ++t)
    if (triangulation.is_inside(t)) queue.push_back(t);
  // In the order of their making, so that the large triangles come first.
  for (std::size_t i = 0; i < queue.size() && sizes.size() < most; ++i) {
    const auto point = point_in(triangulation.corners(queue[i]), triangulation.points(), sizes,
                                rim_count, lone_edges);
    if (!point) continue;
    const auto edges = triangulation.find_cavity(*point, queue[i]);
    if (edges.empty()) continue;
    const auto size = size_in_cavity(*point, edges, triangulation.points(), sizes);
    if (!size) continue;
    sizes.push_back(*size);
    const auto made = triangulation.insert(*point);
    queue.insert(queue.end(), made.begin(), made.end());
  }
  for (int pass = 0; pass < kSmoothings; ++pass) triangulation.smooth(rim_count);
}

}  // namespace sunder::tear
