#include "tear/wound_mask/wall_depths.h"

#include <functional>

#include "core/internal/ordered.h"

namespace sunder::tear {

WallDepths::WallDepths(const SurfaceEditor& torn) : torn_(torn) {
  struct Edge {
    Index from = 0, to = 0;
    double length = 0;
  };
  const Surface& surface = torn.surface();
  std::vector<Edge> edges;
  std::vector<Index> of_lips;
  for (Index t = surface.first_triangle.back(); t < surface.triangle_count(); ++t) {
    if (!is_filling(t, surface) || surface.has_repeated_point(t) || !torn.is_wall(t)) continue;
    for (Index h = 3 * t; h < 3 * t + 3; ++h) {
      const Index next = Surface::next(h), a = surface.corner_point[h],
                  b = surface.corner_point[next];
      const VertexRef at_a = torn.vertex_ref_at(h), at_b = torn.vertex_ref_at(next);
      const double length = norm(torn.births.position(at_b.mesh, at_b.vertex).cast<double>() -
                                 torn.births.position(at_a.mesh, at_a.vertex).cast<double>());
      edges.push_back({a, b, length});
      edges.push_back({b, a, length});
      if (surface.twin[h] != kNone && has_wall(surface.twin[h]))
        of_lips.insert(of_lips.end(), {a, b});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.from < b.from; });
  for (const Edge& edge : edges)
    if (points_.empty() || points_.back().point != edge.from) points_.push_back({edge.from, 0});

  // The shortest ways from all lips at once; each point gets the lip's point that it comes from.
  struct Way {
    double length = 0;
    std::size_t at = 0, from = 0;
    bool operator>(const Way& other) const {
      return std::pair(length, from) > std::pair(other.length, other.from);
    }
  };
  std::priority_queue<Way, std::vector<Way>, std::greater<>> ways;
  for (const Index point : of_lips) ways.push({0, place_of(point), place_of(point)});
  std::vector<bool> is_known(points_.size(), false);
  while (!ways.empty()) {
    const Way way = ways.top();
    ways.pop();
    if (is_known[way.at]) continue;
    is_known[way.at] = true;
    points_[way.from].depth = std::max(points_[way.from].depth, way.length);
    const auto first =
        std::lower_bound(edges.begin(), edges.end(), points_[way.at].point,
                         [](const Edge& edge, Index point) { return edge.from < point; });
    for (auto edge = first; edge != edges.end() && edge->from == first->from; ++edge)
      ways.push({way.length + edge->length, place_of(edge->to), way.from});
  }
}

std::size_t WallDepths::place_of(Index point) const {
  const auto at = std::lower_bound(points_.begin(), points_.end(), point,
                                   [](const Point& of, Index wanted) { return of.point < wanted; });
  return static_cast<std::size_t>(at - points_.begin());
}

double WallDepths::below(Index half_edge) const {
  if (!has_wall(half_edge)) return 0;
  const auto depth_at = [&](Index corner) {
    return points_[place_of(torn_.surface().corner_point[corner])].depth;
  };
  return (depth_at(half_edge) + depth_at(Surface::next(half_edge))) / 2;
}

}  // namespace sunder::tear
