#include "tear/section/graded_points.h"

#include <algorithm>
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
constexpr double kSizePerEdge = 0.8;
/// The growth of the size by the distance from the rim.
constexpr double kGrowth = 0.4;
/// The decline of a long edge's size along the rim, by the distance.
constexpr double kDecline = 0.5;
/// A point with an edge of the rim in its sight at a larger angle than that of this cosine is too
/// close to it.
constexpr double kLeastSightCosine = -0.5;
constexpr int kSmoothings = 2;

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

/// The size at a point whose cavity was found. @return nullopt if the point is too close to the
/// rim.
std::optional<double> size_in_cavity(const Vec2d& p, const ConstrainedDelaunay& triangulation,
                                     std::span<const double> sizes) {
  double size = std::numeric_limits<double>::infinity();
  const auto points = triangulation.points();
  for (const auto& edge : triangulation.cavity_edges()) {
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

  std::pmr::vector<Index> queue(&memory);
  for (Index t = 0; t < triangulation.triangle_count(); ++t)
    if (triangulation.is_inside(t)) queue.push_back(t);
  // In the order of their making, so that the large triangles come first.
  for (std::size_t i = 0; i < queue.size() && sizes.size() < most; ++i) {
    const auto points = triangulation.points();
    const auto corners = triangulation.corners(queue[i]);
    const auto circle = circle_of(points[corners[0]], points[corners[1]], points[corners[2]]);
    if (!circle || !(circle->radius > size_at_centre(corners, circle->radius, sizes))) continue;
    if (!triangulation.find_cavity(circle->centre, queue[i])) continue;
    const auto size = size_in_cavity(circle->centre, triangulation, sizes);
    if (!size) continue;
    sizes.push_back(*size);
    const auto made = triangulation.insert(circle->centre);
    queue.insert(queue.end(), made.begin(), made.end());
  }
  for (int pass = 0; pass < kSmoothings; ++pass) triangulation.smooth(rim_count);
}

}  // namespace sunder::tear
