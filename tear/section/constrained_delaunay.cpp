#include "tear/section/constrained_delaunay.h"

#include <algorithm>
#include <tuple>

#include "tear/internal/surface.h"
#include "tear/section/exact_predicates.h"
#include "tear/section/insertion_order.h"

namespace sunder::tear {
namespace {

/// Whether p, on the line through a and b, lies strictly on the side of a where b is.
bool is_ahead(const Vec2d& a, const Vec2d& b, const Vec2d& p) {
  return a.x() != b.x() ? (b.x() > a.x()) == (p.x() > a.x()) && p.x() != a.x()
                        : (b.y() > a.y()) == (p.y() > a.y()) && p.y() != a.y();
}

/// Triangulates a counter-clockwise polygon that is visible from the edge between its last and
/// first point, by clipping ears in order (Toussaint and Avis 1982). Points may occur twice where
/// the boundary runs to and fro along an edge.
void fill_from_edge(std::span<const Vec2d> points, const std::vector<Index>& polygon,
                    std::vector<std::array<Index, 3>>& triangles) {
  std::vector<Index> stack;
  for (const Index point : polygon) {
    while (stack.size() >= 2) {
      const Index a = stack[stack.size() - 2], b = stack.back();
      if (orientation(points[a], points[b], points[point]) <= 0) break;
      triangles.push_back({a, b, point});
      stack.pop_back();
    }
    stack.push_back(point);
  }
}

}  // namespace

std::optional<ConstrainedDelaunay> ConstrainedDelaunay::of(std::span<const Vec2d> points) {
  if (points.size() < 3) return std::nullopt;
  std::vector<Index> order = insertion_order(points);
  if (points[order[0]] == points[order[1]]) return std::nullopt;
  std::size_t third = 2;
  int turn = 0;
  for (; third < order.size(); ++third) {
    turn = orientation(points[order[0]], points[order[1]], points[order[third]]);
    if (turn != 0) break;
  }
  if (turn == 0) return std::nullopt;
  std::rotate(order.begin() + 2, order.begin() + static_cast<std::ptrdiff_t>(third),
              order.begin() + static_cast<std::ptrdiff_t>(third) + 1);
  if (turn < 0) std::swap(order[0], order[1]);

  ConstrainedDelaunay result(points);
  result.leaving_.assign(points.size(), kNone);
  result.spoke_.assign(points.size() + 1, kNone);
  result.origin_.reserve(6 * points.size());
  result.start(order[0], order[1], order[2]);
  for (std::size_t i = 3; i < order.size(); ++i)
    if (!result.insert(order[i])) return std::nullopt;
  return result;
}

void ConstrainedDelaunay::set_triangle(Index triangle, const std::array<Index, 3>& corners) {
  if (3 * triangle == origin_.size()) {
    origin_.resize(origin_.size() + 3);
    twin_.resize(origin_.size(), kNone);
    fixed_.resize(origin_.size(), 0);
    visit_.push_back(0);
  }
  for (Index i = 0; i < 3; ++i) {
    origin_[3 * triangle + i] = corners[i];
    fixed_[3 * triangle + i] = 0;
    if (corners[i] != kGhost) leaving_[corners[i]] = 3 * triangle + i;
  }
}

void ConstrainedDelaunay::start(Index a, Index b, Index c) {
  const std::array<Index, 3> corners{a, b, c};
  set_triangle(0, corners);
  for (Index i = 0; i < 3; ++i) set_triangle(i + 1, {kGhost, corners[(i + 1) % 3], corners[i]});
  for (Index i = 0; i < 3; ++i) {
    const Index ghost = 3 * (i + 1);
    join(i, ghost + 1);
    join(ghost,
         3 * ((i + 1) % 3 + 1) +
             2);  // ghost to corner i + 1, which the next ghost triangle leaves for the ghost
  }
}

Index ConstrainedDelaunay::hull_edge(Index triangle) const {
  for (Index i = 0; i < 3; ++i)
    if (origin_[3 * triangle + i] == kGhost) return Surface::next(3 * triangle + i);
  return kNone;
}

Index ConstrainedDelaunay::locate(Index point) const {
  const Vec2d& p = points_[point];
  Index triangle = last_;
  if (const Index edge = hull_edge(triangle); edge != kNone) triangle = twin_[edge] / 3;
  Index entered = kNone;
  for (;;) {  // terminates: in a Delaunay triangulation, triangles hide one another from a point
              // without cycles
    Index left = kNone;
    for (Index h = 3 * triangle; h < 3 * triangle + 3 && left == kNone; ++h)
      if (h != entered && orientation(points_[origin_[h]], points_[end(h)], p) < 0) left = h;
    if (left == kNone) break;
    entered = twin_[left];
    triangle = entered / 3;
    if (hull_edge(triangle) != kNone) return triangle;
  }
  for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h)
    if (points_[origin_[h]] == p) return kNone;
  return triangle;
}

bool ConstrainedDelaunay::in_conflict(Index triangle, Index point) const {
  const Vec2d& p = points_[point];
  const Index edge = hull_edge(triangle);
  if (edge == kNone)
    return in_circle(points_[origin_[3 * triangle]], points_[origin_[3 * triangle + 1]],
                     points_[origin_[3 * triangle + 2]], p) > 0;
  const Vec2d &a = points_[origin_[edge]], &b = points_[end(edge)];
  const int side = orientation(
      a, b, p);  // the circle of a ghost: the half-plane outside, and the edge without its ends
  return side > 0 || (side == 0 && is_ahead(a, b, p) && is_ahead(b, a, p));
}

bool ConstrainedDelaunay::insert(Index point) {
  const Index found = locate(point);
  if (found == kNone) return false;
  struct RimEdge {
    Index from, to, outer;
  };
  std::vector<Index> cavity{found};
  std::vector<RimEdge> rim;
  visit_[found] = ++cavity_;
  for (std::size_t i = 0; i < cavity.size(); ++i)
    for (Index h = 3 * cavity[i]; h < 3 * cavity[i] + 3; ++h) {
      const Index across = twin_[h] / 3;
      if (visit_[across] == cavity_) continue;
      if (in_conflict(across, point)) {
        visit_[across] = cavity_;
        cavity.push_back(across);
      } else {
        rim.push_back({origin_[h], end(h), twin_[h]});
      }
    }
  while (cavity.size() < rim.size())
    cavity.push_back(static_cast<Index>(origin_.size() / 3 + (cavity.size() + 2 - rim.size())));
  const auto spoke = [&](Index p) -> Index& { return spoke_[p == kGhost ? points_.size() : p]; };
  for (std::size_t i = 0; i < rim.size(); ++i) {
    set_triangle(cavity[i], {point, rim[i].from, rim[i].to});
    join(3 * cavity[i] + 1, rim[i].outer);
    spoke(rim[i].from) = 3 * cavity[i];
  }
  for (std::size_t i = 0; i < rim.size(); ++i) join(3 * cavity[i] + 2, spoke(rim[i].to));
  last_ = cavity[0];
  return true;
}

bool ConstrainedDelaunay::fix_edge(Index a, Index b) {
  const Vec2d &at_a = points_[a], &at_b = points_[b];
  Index crossing = kNone;  // half-edge from the right of a-b to its left
  Index h = leaving_[a];
  do {
    const Index right = end(h), left = apex(h);
    if (right == b) {
      fixed_[h] = fixed_[twin_[h]] = 1;
      return true;
    }
    if (right != kGhost) {
      const int side = orientation(at_a, at_b, points_[right]);
      if (side == 0 && is_ahead(at_a, at_b, points_[right])) return false;
      if (side < 0 && left != kGhost && orientation(at_a, at_b, points_[left]) > 0)
        crossing = Surface::next(h);
    }
    h = twin_[Surface::previous(h)];
  } while (h != leaving_[a] && crossing == kNone);
  if (crossing == kNone) return false;

  std::vector<Index> crossed{crossing / 3};
  std::vector<Index> rights{a, origin_[crossing]}, lefts{a, end(crossing)};
  for (;;) {
    if (fixed_[crossing] != 0) return false;
    const Index beyond = twin_[crossing];
    const Index tip = apex(beyond);
    crossed.push_back(beyond / 3);
    if (tip == b) break;
    const int side = orientation(at_a, at_b, points_[tip]);
    if (side == 0) return false;
    (side > 0 ? lefts : rights).push_back(tip);
    crossing = side > 0 ? Surface::next(beyond) : Surface::previous(beyond);
  }
  rights.push_back(b);
  lefts.push_back(b);
  std::reverse(lefts.begin(), lefts.end());
  std::vector<std::array<Index, 3>> filling;
  fill_from_edge(points_, rights, filling);
  fill_from_edge(points_, lefts, filling);
  refill(crossed, filling, a, b);
  return true;
}

void ConstrainedDelaunay::refill(const std::vector<Index>& crossed,
                                 const std::vector<std::array<Index, 3>>& filling, Index a,
                                 Index b) {
  struct Link {
    Index low, high, half_edge;  ///< No half-edge: the edge is fixed.
    bool operator<(const Link& o) const {
      return std::tie(low, high, half_edge) < std::tie(o.low, o.high, o.half_edge);
    }
  };
  std::vector<Link> links;
  const auto add = [&](Index from, Index to, Index half_edge) {
    links.push_back({std::min(from, to), std::max(from, to), half_edge});
  };
  add(a, b, kNone);
  ++cavity_;
  for (const Index triangle : crossed) visit_[triangle] = cavity_;
  for (const Index triangle : crossed)
    for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h) {
      if (visit_[twin_[h] / 3] != cavity_) add(origin_[h], end(h), twin_[h]);
      if (fixed_[h] != 0) add(origin_[h], end(h), kNone);
    }
  for (std::size_t i = 0; i < filling.size(); ++i) {
    set_triangle(crossed[i], filling[i]);
    for (Index h = 3 * crossed[i]; h < 3 * crossed[i] + 3; ++h) add(origin_[h], end(h), h);
  }
  std::sort(links.begin(), links.end());
  for (std::size_t i = 0; i + 1 < links.size();) {
    const Index h = links[i].half_edge, other = links[i + 1].half_edge;
    join(h, other);
    const Link edge = links[i];
    i += 2;
    fixed_[h] = fixed_[other] = 0;
    for (; i < links.size() && links[i].low == edge.low && links[i].high == edge.high; ++i)
      fixed_[h] = fixed_[other] = 1;
  }
}

void ConstrainedDelaunay::flip(Index h) {
  const Index g = twin_[h];
  const Index h_next = Surface::next(h), g_next = Surface::next(g);
  const Index tip = apex(h), other_tip = apex(g);
  const Index beyond_h = twin_[h_next], beyond_g = twin_[g_next];
  fixed_[h] = fixed_[g_next];
  fixed_[g] = fixed_[h_next];
  fixed_[h_next] = fixed_[g_next] = 0;
  origin_[h_next] = other_tip;
  origin_[g_next] = tip;
  join(h, beyond_g);
  join(g, beyond_h);
  join(h_next, g_next);
}

void ConstrainedDelaunay::make_delaunay(const std::vector<char>& is_inside) {
  std::vector<Index> suspects;
  for (Index h = 0; h < origin_.size(); ++h)
    if (is_inside[h / 3] != 0 && h < twin_[h]) suspects.push_back(h);
  while (!suspects.empty()) {
    const Index h = suspects.back();
    suspects.pop_back();
    const Index g = twin_[h];
    if (fixed_[h] != 0 ||
        in_circle(points_[origin_[h]], points_[end(h)], points_[apex(h)], points_[apex(g)]) <= 0)
      continue;
    flip(h);
    for (const Index side : {h, Surface::previous(h), g, Surface::previous(g)})
      suspects.push_back(side);
  }
}

std::vector<std::array<Index, 3>> ConstrainedDelaunay::inside() && {
  const auto triangle_count = static_cast<Index>(origin_.size() / 3);
  constexpr char kUnknown = 2;
  std::vector<char> is_inside(triangle_count, kUnknown);
  std::vector<Index> queue;
  for (Index t = 0; t < triangle_count; ++t)
    if (hull_edge(t) != kNone) {
      is_inside[t] = 0;
      queue.push_back(t);
    }
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (Index h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h) {
      const Index across = twin_[h] / 3;
      if (is_inside[across] != kUnknown) continue;
      is_inside[across] = static_cast<char>(is_inside[queue[i]] ^ fixed_[h]);
      queue.push_back(across);
    }

  std::vector<char> is_reached(triangle_count, 0);
  std::vector<Index> piece;
  const auto first = std::find(is_inside.begin(), is_inside.end(), char{1});
  if (first == is_inside.end()) return {};
  piece.push_back(static_cast<Index>(first - is_inside.begin()));
  is_reached[piece[0]] = 1;
  for (std::size_t i = 0; i < piece.size(); ++i)
    for (Index h = 3 * piece[i]; h < 3 * piece[i] + 3; ++h) {
      const Index across = twin_[h] / 3;
      if (fixed_[h] != 0 || is_reached[across] != 0) continue;
      is_reached[across] = 1;
      piece.push_back(across);
    }
  if (static_cast<std::ptrdiff_t>(piece.size()) !=
      std::count(is_inside.begin(), is_inside.end(), char{1}))
    return {};

  make_delaunay(is_inside);
  std::sort(piece.begin(), piece.end());
  std::vector<std::array<Index, 3>> triangles;
  triangles.reserve(piece.size());
  for (const Index t : piece)
    triangles.push_back({origin_[3 * t], origin_[3 * t + 1], origin_[3 * t + 2]});
  return triangles;
}

}  // namespace sunder::tear
