#include "tear/section/constrained_delaunay.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "core/internal/ordered.h"
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

/// Twice the area of a triangle by the square of its longest side.
double shape(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  const Vec2d ab = b - a, ac = c - a;
  const double longest = std::max({squared_norm(ab), squared_norm(ac), squared_norm(ac - ab)});
  return longest > 0 ? (ab.x() * ac.y() - ab.y() * ac.x()) / longest : 0.0;
}

/// Triangulates a counter-clockwise polygon that is visible from the edge between its last and
/// first point, by clipping ears in order (Toussaint and Avis 1982). Points may occur twice where
/// the boundary runs to and fro along an edge.
void fill_from_edge(std::span<const Vec2d> points, std::span<const Index> polygon,
                    std::pmr::vector<Index>& stack,
                    std::pmr::vector<std::array<Index, 3>>& triangles) {
  stack.clear();
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

ConstrainedDelaunay::Crossing::Crossing(std::pmr::memory_resource& memory)
    : crossed(&memory),
      rights(&memory),
      lefts(&memory),
      stack(&memory),
      filling(&memory),
      links(&memory) {}

ConstrainedDelaunay::ConstrainedDelaunay(std::span<const Vec2d> points, std::size_t spare,
                                         std::pmr::memory_resource& memory)
    : points_(&memory),
      origin_(&memory),
      twin_(&memory),
      fixed_(&memory),
      inside_(&memory),
      visit_(&memory),
      leaving_(&memory),
      spoke_(&memory),
      cavity_(&memory),
      rim_(&memory),
      crossing_(memory) {
  const std::size_t most = points.size() + spare;
  points_.reserve(most);
  points_.assign(points.begin(), points.end());
  leaving_.reserve(most);
  leaving_.assign(points.size(), kNone);
  spoke_.reserve(most + 1);
  spoke_.assign(points.size() + 1, kNone);
  // n points and the ghost have 2 n - 2 triangles.
  origin_.reserve(6 * most);
  twin_.reserve(6 * most);
  fixed_.reserve(6 * most);
  inside_.reserve(2 * most);
  visit_.reserve(2 * most);
  cavity_.reserve(2 * points.size());
  rim_.reserve(64);
}

std::optional<ConstrainedDelaunay> ConstrainedDelaunay::of(std::span<const Vec2d> points,
                                                           std::size_t spare,
                                                           std::pmr::memory_resource& memory) {
  if (points.size() < 3) return std::nullopt;
  std::optional<ConstrainedDelaunay> result(ConstrainedDelaunay(points, spare, memory));
  std::pmr::vector<Index> order = insertion_order(points, memory);
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
  if (!result->insert_all(order)) return std::nullopt;
  return result;
}

bool ConstrainedDelaunay::insert_all(std::span<const Index> order) {
  start(order[0], order[1], order[2]);
  for (const Index point : order.subspan(3)) {
    const Index found = locate(point);
    if (found == kNone) return false;
    grow_cavity(found, points_[point]);
    fill_cavity(point);
  }
  return true;
}

void ConstrainedDelaunay::set_triangle(Index triangle, const Corners& corners) {
  if (3 * triangle == origin_.size()) {
    origin_.resize(origin_.size() + 3);
    twin_.resize(origin_.size(), kNone);
    fixed_.resize(origin_.size(), 0);
    inside_.push_back(kUnknown);
    visit_.push_back(0);
  }
  for (Index i = 0; i < 3; ++i) {
    origin_[3 * triangle + i] = corners[i];
    fixed_[3 * triangle + i] = 0;
    if (corners[i] != kGhost) leaving_[corners[i]] = 3 * triangle + i;
  }
}

void ConstrainedDelaunay::start(Index a, Index b, Index c) {
  const Corners corners{a, b, c};
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

Index ConstrainedDelaunay::locate_inside(const Vec2d& p, Index from) const {
  // Unfixed edges are locally Delaunay, so this walk has no cycles either.
  Index triangle = from, entered = kNone;
  for (;;) {
    Index left = kNone;
    bool is_behind_fixed = false;
    for (Index h = 3 * triangle; h < 3 * triangle + 3 && left == kNone; ++h) {
      if (h == entered) continue;
      const int side = orientation(points_[origin_[h]], points_[end(h)], p);
      if (side < 0 && fixed_[h] == 0) left = h;
      is_behind_fixed |= side <= 0 && fixed_[h] != 0;
    }
    if (left == kNone) return is_behind_fixed ? kNone : triangle;
    entered = twin_[left];
    triangle = entered / 3;
  }
}

bool ConstrainedDelaunay::in_conflict(Index triangle, const Vec2d& p) const {
  const Index edge = hull_edge(triangle);
  if (edge == kNone)
    return in_circle(points_[origin_[3 * triangle]], points_[origin_[3 * triangle + 1]],
                     points_[origin_[3 * triangle + 2]], p) > 0;
  const Vec2d &a = points_[origin_[edge]], &b = points_[end(edge)];
  const int side = orientation(
      a, b, p);  // the circle of a ghost: the half-plane outside, and the edge without its ends
  return side > 0 || (side == 0 && is_ahead(a, b, p) && is_ahead(b, a, p));
}

/// Finds the triangles around `found` whose circles contain a point, and the edges around them.
void ConstrainedDelaunay::grow_cavity(Index found, const Vec2d& point) {
  cavity_.assign(1, found);
  rim_.clear();
  visit_[found] = ++cavity_number_;
  for (std::size_t i = 0; i < cavity_.size(); ++i)
    for (Index h = 3 * cavity_[i]; h < 3 * cavity_[i] + 3; ++h) {
      const Index across = twin_[h] / 3;
      if (visit_[across] == cavity_number_) continue;
      if (fixed_[h] == 0 && in_conflict(across, point)) {
        visit_[across] = cavity_number_;
        cavity_.push_back(across);
      } else {
        rim_.push_back({origin_[h], end(h), twin_[h], fixed_[h] != 0});
      }
    }
}

/// Replaces the triangles of the cavity by a fan around a point.
void ConstrainedDelaunay::fill_cavity(Index point) {
  const char inside = inside_[cavity_[0]];
  while (cavity_.size() < rim_.size())
    cavity_.push_back(static_cast<Index>(origin_.size() / 3 + (cavity_.size() + 2 - rim_.size())));
  for (std::size_t i = 0; i < rim_.size(); ++i) {
    const Index first = 3 * cavity_[i];
    set_triangle(cavity_[i], {point, rim_[i].from, rim_[i].to});
    inside_[cavity_[i]] = inside;
    join(first + 1, rim_[i].outer);
    fixed_[first + 1] = rim_[i].is_fixed ? 1 : 0;
    spoke(rim_[i].from) = first;
  }
  for (std::size_t i = 0; i < rim_.size(); ++i) join(3 * cavity_[i] + 2, spoke(rim_[i].to));
  last_ = cavity_[0];
}

/// Whether the cavity is a polygon of which every edge is seen from the point. It is, except where
/// it reaches around the end of a fixed edge.
bool ConstrainedDelaunay::is_star_around(const Vec2d& point) {
  if (rim_.size() != cavity_.size() + 2) return false;
  for (const CavityEdge& edge : rim_) spoke(edge.from) = kNone;
  for (const CavityEdge& edge : rim_) {
    if (spoke(edge.from) != kNone) return false;
    spoke(edge.from) = edge.to;
    if (orientation(points_[edge.from], points_[edge.to], point) <= 0) return false;
  }
  return true;
}

std::span<const ConstrainedDelaunay::CavityEdge> ConstrainedDelaunay::find_cavity(
    const Vec2d& point, Index from) {
  const Index found = locate_inside(point, from);
  if (found == kNone) return {};
  grow_cavity(found, point);
  if (!is_star_around(point)) return {};
  return rim_;
}

std::span<const Index> ConstrainedDelaunay::insert(const Vec2d& point) {
  points_.push_back(point);
  leaving_.push_back(kNone);
  spoke_.push_back(kNone);
  fill_cavity(static_cast<Index>(points_.size() - 1));
  return cavity_;
}

void ConstrainedDelaunay::smooth(Index first) {
  for (Index p = first; p < points_.size(); ++p) {
    const auto for_each_ring_edge = [&](auto visit) {
      Index h = leaving_[p];
      do {
        visit(points_[end(h)], points_[apex(h)]);
        h = twin_[Surface::previous(h)];
      } while (h != leaving_[p]);
    };
    Vec2d mean = Vec2d::Zero();
    double count = 0, before = std::numeric_limits<double>::infinity(), after = before;
    for_each_ring_edge([&](const Vec2d& a, const Vec2d& b) {
      mean += a;
      ++count;
      before = std::min(before, shape(points_[p], a, b));
    });
    mean /= count;
    bool is_inside = true;
    for_each_ring_edge([&](const Vec2d& a, const Vec2d& b) {
      after = std::min(after, shape(mean, a, b));
      is_inside = is_inside && orientation(mean, a, b) > 0;
    });
    if (is_inside && after > before) points_[p] = mean;
  }
  crossing_.is_used = true;
  make_delaunay();
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

  auto& [crossed, rights, lefts, stack, filling, links, is_used] = crossing_;
  crossed.assign(1, crossing / 3);
  rights.assign({a, origin_[crossing]});
  lefts.assign({a, end(crossing)});
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
  filling.clear();
  fill_from_edge(points_, rights, stack, filling);
  fill_from_edge(points_, lefts, stack, filling);
  is_used = true;
  refill(a, b);
  return true;
}

/// Replaces the crossed triangles.
void ConstrainedDelaunay::refill(Index a, Index b) {
  const auto& [crossed, rights, lefts, stack, filling, _, is_used] = crossing_;
  auto& links = crossing_.links;
  links.clear();
  const auto add = [&](Index from, Index to, Index half_edge) {
    links.push_back({std::min(from, to), std::max(from, to), half_edge});
  };
  add(a, b, kNone);
  ++cavity_number_;
  for (const Index triangle : crossed) visit_[triangle] = cavity_number_;
  for (const Index triangle : crossed)
    for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h) {
      if (visit_[twin_[h] / 3] != cavity_number_) add(origin_[h], end(h), twin_[h]);
      if (fixed_[h] != 0) add(origin_[h], end(h), kNone);
    }
  for (std::size_t i = 0; i < filling.size(); ++i) {
    set_triangle(crossed[i], filling[i]);
    for (Index h = 3 * crossed[i]; h < 3 * crossed[i] + 3; ++h) add(origin_[h], end(h), h);
  }
  using Link = Crossing::Link;
  std::sort(links.begin(), links.end(), [](const Link& x, const Link& y) {
    return std::tie(x.low, x.high, x.half_edge) < std::tie(y.low, y.high, y.half_edge);
  });
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
  leaving_[origin_[h]] = h;
  leaving_[origin_[g]] = g;
  join(h, beyond_g);
  join(g, beyond_h);
  join(h_next, g_next);
}

/// Flips the inner edges that are not Delaunay; there are none unless triangles were replaced.
void ConstrainedDelaunay::make_delaunay() {
  if (!crossing_.is_used) return;
  std::pmr::vector<Index>& suspects = crossing_.stack;
  suspects.clear();
  for (Index h = 0; h < origin_.size(); ++h)
    if (inside_[h / 3] == 1 && h < twin_[h]) suspects.push_back(h);
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

/// Whether the inside triangles are connected across unfixed edges, and there are any.
bool ConstrainedDelaunay::is_one_piece() {
  std::pmr::vector<Index>& piece = cavity_;
  const auto first = std::find(inside_.begin(), inside_.end(), char{1});
  if (first == inside_.end()) return false;
  piece.assign(1, static_cast<Index>(first - inside_.begin()));
  visit_[piece[0]] = ++cavity_number_;
  for (std::size_t i = 0; i < piece.size(); ++i)
    for (Index h = 3 * piece[i]; h < 3 * piece[i] + 3; ++h) {
      const Index across = twin_[h] / 3;
      if (fixed_[h] != 0 || visit_[across] == cavity_number_) continue;
      visit_[across] = cavity_number_;
      piece.push_back(across);
    }
  return static_cast<std::ptrdiff_t>(piece.size()) ==
         std::count(inside_.begin(), inside_.end(), char{1});
}

bool ConstrainedDelaunay::find_inside() {
  std::pmr::vector<Index>& queue = cavity_;
  queue.clear();
  for (Index t = 0; t < triangle_count(); ++t) {
    const bool is_ghost = hull_edge(t) != kNone;
    inside_[t] = is_ghost ? char{0} : kUnknown;
    if (is_ghost) queue.push_back(t);
  }
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (Index h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h) {
      const Index across = twin_[h] / 3;
      if (inside_[across] != kUnknown) continue;
      inside_[across] = static_cast<char>(inside_[queue[i]] ^ fixed_[h]);
      queue.push_back(across);
    }
  if (!is_one_piece()) return false;
  make_delaunay();
  return true;
}

}  // namespace sunder::tear
