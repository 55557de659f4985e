#include "support/models/flat_loops.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sunder::test {

using tear::FlatLoop;

double area_of(std::span<const Vec2d> loop) {
  double twice = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2d a = loop[i] - loop[0], b = loop[(i + 1) % loop.size()] - loop[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

bool is_inside(const FlatLoop& loop, const Vec2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
    if ((a.y() <= p.y()) != (b.y() <= p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside;
}

Vec2d polar(double angle, double radius) {
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

FlatLoop star(Random& random, std::uint32_t count, const Vec2d& centre, double radius) {
  FlatLoop loop;
  const bool is_smooth = random.index(2) == 0;
  for (std::uint32_t i = 0; i < count; ++i)
    loop.push_back(centre + polar(2 * std::numbers::pi * i / count,
                                  radius * (is_smooth ? 0.8 : random.uniform(0.6, 1))));
  if (random.index(2) == 0) std::reverse(loop.begin(), loop.end());
  return loop;
}

namespace {

void add_nested(Random& random, const Vec2d& centre, double radius, int depth,
                std::vector<FlatLoop>& loops) {
  loops.push_back(star(random, 8 + random.index(40), centre, radius));
  if (depth == 0) return;
  const std::uint32_t children = random.index(4);
  if (children == 1) add_nested(random, centre, 0.5 * radius, depth - 1, loops);
  if (children > 1)  // circles of a third of the radius around the middle; a polygon of 8 is within
                     // 0.55 of the radius everywhere
    for (std::uint32_t i = 0; i < children; ++i)
      add_nested(random, centre + polar(2 * std::numbers::pi * i / children, 0.3 * radius),
                 0.2 * radius, depth - 1, loops);
}

}  // namespace

FlatLoop spiral(int turns, int points_a_turn, double width) {
  FlatLoop loop;
  const int count = turns * points_a_turn;
  for (int i = 0; i <= count; ++i)
    loop.push_back(polar(2 * std::numbers::pi * i / points_a_turn, 1 + double(i) / points_a_turn));
  for (int i = count; i >= 0; --i)
    loop.push_back(
        polar(2 * std::numbers::pi * i / points_a_turn, 1 + width + double(i) / points_a_turn));
  return loop;
}

FlatLoop comb(int teeth, double depth) {
  FlatLoop loop{{0, -1}, {2.0 * teeth - 1, -1}};
  for (int i = teeth - 1; i >= 0; --i) {
    loop.insert(loop.end(), {{2.0 * i + 1, depth}, {2.0 * i, depth}});
    if (i > 0) loop.insert(loop.end(), {{2.0 * i, 0}, {2.0 * i - 1, 0}});
  }
  return loop;
}

FlatLoop refined(const FlatLoop& loop, int parts) {
  FlatLoop result;
  for (std::size_t i = 0; i < loop.size(); ++i)
    for (int k = 0; k < parts; ++k)
      result.push_back(loop[i] + (loop[(i + 1) % loop.size()] - loop[i]) * (double(k) / parts));
  return result;
}

std::vector<FlatLoop> grid_of_holes(int side, int parts) {
  std::vector<FlatLoop> loops{
      refined({{0, 0}, {4.0 * side, 0}, {4.0 * side, 4.0 * side}, {0, 4.0 * side}}, parts * side)};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const Vec2d at(4.0 * x + 1, 4.0 * y + 1);
      loops.push_back(refined({at, at + Vec2d(0, 2), at + Vec2d(2, 2), at + Vec2d(2, 0)}, parts));
    }
  return loops;
}

std::vector<std::vector<FlatLoop>> letters() {
  return {
      {{{0, 0},
        {4, 0},
        {4, 1},
        {1, 1},
        {1, 2},
        {3, 2},
        {3, 3},
        {1, 3},
        {1, 4},
        {4, 4},
        {4, 5},
        {0, 5}}},  // E
      {{{0, 0},
        {1, 0},
        {1, 2},
        {3, 2},
        {3, 0},
        {4, 0},
        {4, 5},
        {3, 5},
        {3, 3},
        {1, 3},
        {1, 5},
        {0, 5}}},  // H
      {{{0, 0}, {1, 0}, {1.5, 2}, {2.5, 2}, {3, 0}, {4, 0}, {2.5, 5}, {1.5, 5}},
       {{1.75, 3}, {2, 4}, {2.25, 3}}},  // A
      {{{0, 0}, {3, 0}, {4, 1}, {4, 2}, {3.5, 2.5}, {4, 3}, {4, 4}, {3, 5}, {0, 5}},
       {{1, 1}, {1, 2}, {3, 2}, {3, 1}},
       {{1, 3}, {1, 4}, {3, 4}, {3, 3}}},                                                       // B
      {{{0, 0}, {4, 0}, {4, 1}, {1.5, 1}, {4, 4}, {4, 5}, {0, 5}, {0, 4}, {2.5, 4}, {0, 1}}}};  // Z
}
std::vector<FlatLoop> alternated(std::vector<FlatLoop> loops) {
  std::vector<int> depths(loops.size(), 0);
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (std::size_t k = 0; k < loops.size(); ++k)
      if (k != i && is_inside(loops[k], 0.5 * (loops[i][0] + loops[i][1]))) ++depths[i];
  for (std::size_t i = 0; i < loops.size(); ++i) {
    double area = 0;
    for (std::size_t k = 0; k < loops[i].size(); ++k) {
      const Vec2d a = loops[i][k] - loops[i][0],
                  b = loops[i][(k + 1) % loops[i].size()] - loops[i][0];
      area += a.x() * b.y() - a.y() * b.x();
    }
    if ((area < 0) != (depths[i] % 2 == 1)) std::reverse(loops[i].begin(), loops[i].end());
  }
  return loops;
}
std::vector<FlatLoop> random_nested(Random& random) {
  std::vector<FlatLoop> loops;
  const std::uint32_t roots = 1 + random.index(3);
  for (std::uint32_t i = 0; i < roots; ++i) add_nested(random, {2.5 * i, 0}, 1, 5, loops);
  for (std::size_t i = loops.size(); i > 1; --i)
    std::swap(loops[i - 1], loops[random.index(static_cast<std::uint32_t>(i))]);
  const double scale = std::pow(10.0, static_cast<double>(random.index(4)) * 2 - 6);
  const Vec2d offset = random.index(3) == 0 ? Vec2d(1e6 * scale, -3e5 * scale) : Vec2d(0, 0);
  for (FlatLoop& loop : loops)
    for (Vec2d& p : loop) p = scale * p + offset;
  return alternated(std::move(loops));
}
}  // namespace sunder::test
