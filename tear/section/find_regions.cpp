#include <algorithm>
#include <cmath>

#include "tear/section/exact_predicates.h"
#include "tear/section/flat_section.h"

namespace sunder::tear {
namespace {

struct Loop {
  explicit Loop(std::pmr::memory_resource& memory) : points(&memory) {}

  Index index = 0;  ///< In the caller's list.
  FlatLoop points;
  Vec2d low, high;
  double area = 0;  ///< Approximate.
  bool is_clockwise = false;
};

enum class Side { outside, on, inside };

std::pmr::vector<Loop> loops_with_area(std::span<const FlatLoop> loops,
                                       std::pmr::memory_resource& memory) {
  std::pmr::vector<Loop> result(&memory);
  result.reserve(loops.size());
  for (Index i = 0; i < loops.size(); ++i) {
    Loop loop(memory);
    loop.points.reserve(loops[i].size());
    loop.index = i;
    for (const Vec2d& p : loops[i]) {
      const auto point = exact_range(p);
      if (!point) break;
      loop.points.push_back(*point);
    }
    const int sign = loop.points.size() == loops[i].size() ? area_sign(loop.points) : 0;
    if (sign == 0) continue;
    loop.low = loop.high = loop.points[0];
    for (std::size_t k = 0; k < loop.points.size(); ++k) {
      const Vec2d a = loop.points[k] - loop.points[0],
                  b = loop.points[(k + 1) % loop.points.size()] - loop.points[0];
      loop.area += 0.5 * (a.x() * b.y() - a.y() * b.x());
      loop.low = loop.low.cwiseMin(loop.points[k]);
      loop.high = loop.high.cwiseMax(loop.points[k]);
    }
    loop.area = std::abs(loop.area);
    loop.is_clockwise = sign < 0;
    result.push_back(std::move(loop));
  }
  return result;
}

bool box_holds(const Loop& loop, const Vec2d& p) {
  return (loop.low.array() <= p.array()).all() && (p.array() <= loop.high.array()).all();
}

Side side_of(const Loop& loop, const Vec2d& p) {
  if (!box_holds(loop, p)) return Side::outside;
  bool is_inside = false;
  for (std::size_t k = 0; k < loop.points.size(); ++k) {
    const Vec2d &a = loop.points[k], &b = loop.points[k + 1 == loop.points.size() ? 0 : k + 1];
    if (a == p) return Side::on;
    if (a.y() == p.y() && b.y() == p.y() && (a.x() < p.x()) != (b.x() < p.x())) return Side::on;
    if ((a.y() <= p.y()) == (b.y() <= p.y())) continue;
    const int turn = orientation(a, b, p);
    if (turn == 0) return Side::on;
    if ((turn > 0) == (b.y() > a.y()))
      is_inside = !is_inside;  // the ray towards +x crosses the edge
  }
  return is_inside ? Side::inside : Side::outside;
}

/// Whether `outer` contains `inner`, decided by the first point of `inner` that is not on `outer`,
/// otherwise by the first such midpoint of an edge. Of coincident loops the first contains the
/// other.
bool holds(const Loop& outer, const Loop& inner) {
  if (!box_holds(outer, inner.low) || !box_holds(outer, inner.high)) return false;
  for (const Vec2d& p : inner.points)
    if (const Side side = side_of(outer, p); side != Side::on) return side == Side::inside;
  for (std::size_t k = 0; k < inner.points.size(); ++k) {
    const Vec2d middle = 0.5 * (inner.points[k] + inner.points[(k + 1) % inner.points.size()]);
    if (const Side side = side_of(outer, middle); side != Side::on) return side == Side::inside;
  }
  return outer.index < inner.index;
}

}  // namespace

std::pmr::vector<FlatRegion> find_regions(std::span<const FlatLoop> all_loops,
                                          std::pmr::memory_resource& memory) {
  std::pmr::vector<FlatRegion> regions(&memory);
  const std::pmr::vector<Loop> loops = loops_with_area(all_loops, memory);
  std::pmr::vector<std::pmr::vector<std::size_t>> holders(loops.size(), &memory);
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (std::size_t k = 0; k < loops.size(); ++k)
      if (k != i && holds(loops[k], loops[i])) holders[i].push_back(k);

  // A loop is a hole if its direction is opposite to the outermost loop around it.
  std::pmr::vector<char> is_hole(loops.size(), 0, &memory);
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (const std::size_t k : holders[i])
      if (holders[k].empty()) is_hole[i] = loops[i].is_clockwise != loops[k].is_clockwise ? 1 : 0;

  std::pmr::vector<std::size_t> region_of(loops.size(), loops.size(), &memory);
  // It belongs to the innermost outline of opposite direction that contains it. Among crossing
  // loops there may be none; then it is its own outline.
  std::pmr::vector<std::size_t> outline_of(loops.size(), 0, &memory);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    std::size_t best = i;
    if (is_hole[i] != 0)
      for (const std::size_t k : holders[i]) {
        if (is_hole[k] != 0 || loops[k].is_clockwise == loops[i].is_clockwise) continue;
        if (best == i || holders[k].size() > holders[best].size() ||
            (holders[k].size() == holders[best].size() && loops[k].area < loops[best].area))
          best = k;
      }
    outline_of[i] = best;
    if (best != i) continue;
    region_of[i] = regions.size();
    regions.push_back({loops[i].index, std::pmr::vector<Index>(&memory)});
  }
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (outline_of[i] != i) regions[region_of[outline_of[i]]].holes.push_back(loops[i].index);
  return regions;
}

}  // namespace sunder::tear
