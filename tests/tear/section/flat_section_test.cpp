// Flat regions of all shapes, random and degenerate: the result is a constrained Delaunay
// triangulation or nothing.
#include "tear/section/flat_section.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/stress.h"
#include "tear/section/exact_predicates.h"

namespace sunder::tear {
namespace {

using test::Random;
using testing::ElementsAre;
using testing::IsEmpty;

int case_count(int usual) { return test::stressed(usual, 20); }

double area_of(std::span<const Vec2d> loop) {
  double twice = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2d a = loop[i] - loop[0], b = loop[(i + 1) % loop.size()] - loop[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

Vec2d polar(double angle, double radius) {
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Around `centre`, at a distance between 0.6 and 1 of `radius`.
FlatLoop star(Random& random, std::uint32_t count, const Vec2d& centre, double radius) {
  FlatLoop loop;
  const bool is_smooth = random.index(2) == 0;
  for (std::uint32_t i = 0; i < count; ++i)
    loop.push_back(centre + polar(2 * std::numbers::pi * i / count,
                                  radius * (is_smooth ? 0.8 : random.uniform(0.6, 1))));
  if (random.index(2) == 0) std::reverse(loop.begin(), loop.end());
  return loop;
}

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

/// Adds points on the edges: exactly collinear if coordinates allow it.
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

std::vector<Vec2d> all_points(std::span<const FlatLoop> loops, const FlatRegion& region,
                              const FlatMesh& mesh) {
  std::vector<Vec2d> points(loops[region.outline].begin(), loops[region.outline].end());
  for (const Index hole : region.holes)
    points.insert(points.end(), loops[hole].begin(), loops[hole].end());
  points.insert(points.end(), mesh.inner.begin(), mesh.inner.end());
  return points;
}

Index rim_count(std::span<const FlatLoop> loops, const FlatRegion& region) {
  std::size_t count = loops[region.outline].size();
  for (const Index hole : region.holes) count += loops[hole].size();
  return static_cast<Index>(count);
}

/// Checks the guarantees in the header of triangulate().
void expect_constrained_delaunay(std::span<const FlatLoop> loops, const FlatRegion& region,
                                 const FlatMesh& mesh) {
  const std::vector<Vec2d> points = all_points(loops, region, mesh);
  const Index rim = rim_count(loops, region);
  std::map<std::pair<Index, Index>, Index> apex;  // of half-edges
  double area = 0, scale = 0;
  std::vector<char> is_used(points.size(), 0);
  for (const auto& t : mesh.triangles) {
    for (const Index p : t) {
      ASSERT_LT(p, points.size());
      is_used[p] = 1;
    }
    ASSERT_EQ(orientation(points[t[0]], points[t[1]], points[t[2]]), 1);
    area += 0.5 * ((points[t[1]] - points[t[0]]).x() * (points[t[2]] - points[t[0]]).y() -
                   (points[t[1]] - points[t[0]]).y() * (points[t[2]] - points[t[0]]).x());
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_TRUE(apex.emplace(std::pair{t[i], t[(i + 1) % 3]}, t[(i + 2) % 3]).second)
          << "an edge with two faces on one side";
  }
  ASSERT_EQ(std::count(is_used.begin(), is_used.end(), 1),
            static_cast<std::ptrdiff_t>(points.size()));
  ASSERT_EQ(mesh.twins.size(), 3 * mesh.triangles.size());
  for (Index edge = 0; edge < mesh.twins.size(); ++edge) {
    const auto begin_of = [&](Index e) { return mesh.triangles[e / 3][e % 3]; };
    const auto end_of = [&](Index e) { return mesh.triangles[e / 3][(e + 1) % 3]; };
    const Index twin = mesh.twins[edge];
    ASSERT_EQ(twin == kNone, apex.count({end_of(edge), begin_of(edge)}) == 0);
    if (twin == kNone) continue;
    ASSERT_EQ(begin_of(twin), end_of(edge));
    ASSERT_EQ(end_of(twin), begin_of(edge));
  }

  double expected_area = 0;
  std::set<std::pair<Index, Index>> loop_edges;
  Index first = 0;
  std::vector<Index> members{region.outline};
  members.insert(members.end(), region.holes.begin(), region.holes.end());
  for (const Index l : members) {
    const auto count = static_cast<Index>(loops[l].size());
    expected_area += (l == region.outline ? 1 : -1) * std::abs(area_of(loops[l]));
    for (Index i = 0; i < count; ++i) {
      const Index a = first + i, b = first + (i + 1) % count;
      ASSERT_EQ(apex.count({a, b}) + apex.count({b, a}), 1u);
      loop_edges.insert({a, b});
      loop_edges.insert({b, a});
      scale = std::max(scale, (points[a] - points[0]).squaredNorm());
    }
    first += count;
  }
  ASSERT_NEAR(area, expected_area, 1e-12 * scale);
  for (const auto& [edge, tip] : apex) {
    if (loop_edges.count(edge) != 0) continue;
    const auto other = apex.find({edge.second, edge.first});
    ASSERT_NE(other, apex.end()) << "an inner edge with one face";
    ASSERT_LE(
        in_circle(points[edge.first], points[edge.second], points[tip], points[other->second]), 0);
  }
  ASSERT_EQ(mesh.triangles.size(),
            rim + 2 * region.holes.size() + 2 * mesh.inner.size() - 2);  // Euler's formula
}

/// Checks that inner points are not closer to any point than the closest neighbours on the rim.
void expect_inner_points_in_place(std::span<const FlatLoop> loops, const FlatRegion& region,
                                  const FlatMesh& mesh) {
  const std::vector<Vec2d> points = all_points(loops, region, mesh);
  const Index rim = rim_count(loops, region);
  ASSERT_LE(mesh.inner.size(), 2 * rim + 64);
  double least = std::numeric_limits<double>::infinity();
  std::vector<Index> members{region.outline};
  members.insert(members.end(), region.holes.begin(), region.holes.end());
  for (const Index l : members)
    for (std::size_t i = 0; i < loops[l].size(); ++i)
      least = std::min(least, (loops[l][i] - loops[l][(i + 1) % loops[l].size()]).norm());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (std::max(t[k], t[(k + 1) % 3]) >= rim) {
        ASSERT_GT((points[t[k]] - points[t[(k + 1) % 3]]).norm(), 0.4 * least);
      }
}

/// Triangulates every region, which must succeed, with and without inner points. @return inner
/// points.
std::size_t expect_regions_triangulate(const std::vector<FlatLoop>& loops) {
  std::size_t inner = 0;
  const auto regions = find_regions(loops);
  EXPECT_FALSE(regions.empty());
  for (const FlatRegion& region : regions)
    for (const InnerPoints wanted : {InnerPoints::none, InnerPoints::graded}) {
      const auto mesh = triangulate(loops, region, wanted);
      EXPECT_TRUE(mesh.has_value());
      if (!mesh) continue;
      expect_constrained_delaunay(loops, region, *mesh);
      expect_inner_points_in_place(loops, region, *mesh);
      if (wanted == InnerPoints::none) {
        EXPECT_THAT(mesh->inner, IsEmpty());
      }
      inner += mesh->inner.size();
    }
  return inner;
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

/// Orients the loops so that holes are opposite to the loop around them.
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

/// Random loops nested up to five deep, moved and scaled.
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

TEST(FindRegions, alternates_outlines_and_holes) {
  const auto square = [](double x, double half) {
    return FlatLoop{{x - half, -half}, {x + half, -half}, {x + half, half}, {x - half, half}};
  };
  const auto loops = alternated({square(0, 1), square(0, 5), square(0, 3), square(0, 2),
                                 square(0, 4), square(20, 1), square(4.5, 0.2)});
  const auto regions = find_regions(loops);
  ASSERT_EQ(regions.size(), 4u);
  EXPECT_EQ(regions[0].outline, 0u);
  EXPECT_THAT(regions[0].holes, IsEmpty());
  EXPECT_EQ(regions[1].outline, 1u);
  EXPECT_THAT(regions[1].holes, ElementsAre(4, 6));
  EXPECT_EQ(regions[2].outline, 2u);
  EXPECT_THAT(regions[2].holes, ElementsAre(3));
  EXPECT_EQ(regions[3].outline, 5u);
}

TEST(FindRegions, covers_points_inside_an_odd_number_of_loops) {
  for (int seed = 0; seed < case_count(200); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const auto loops = random_nested(random);
    const auto regions = find_regions(loops);
    std::vector<int> uses(loops.size(), 0);
    for (const FlatRegion& region : regions) {
      ++uses[region.outline];
      for (const Index hole : region.holes) ++uses[hole];
    }
    ASSERT_THAT(uses, testing::Each(1));
    for (int i = 0; i < 200; ++i) {
      const FlatLoop& near = loops[random.index(static_cast<std::uint32_t>(loops.size()))];
      const double size = (near[0] - near[near.size() / 2]).norm();
      const Vec2d p = near[0] + size * Vec2d{random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5)};
      int parity = 0, covered = 0;
      for (const FlatLoop& loop : loops) parity ^= is_inside(loop, p) ? 1 : 0;
      for (const FlatRegion& region : regions)
        covered += is_inside(loops[region.outline], p) &&
                   std::none_of(region.holes.begin(), region.holes.end(),
                                [&](Index hole) { return is_inside(loops[hole], p); });
      ASSERT_EQ(covered, parity);
    }
  }
}

TEST(FindRegions, keeps_bodies_in_one_another_apart) {
  const FlatLoop outer{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, inner{{1, 1}, {3, 1}, {3, 3}, {1, 3}},
      hole{{2, 2}, {2, 2.5}, {2.5, 2}};
  const auto regions = find_regions(std::vector<FlatLoop>{outer, inner, hole});
  ASSERT_EQ(regions.size(), 2u);
  EXPECT_THAT(regions[0].holes, IsEmpty());
  EXPECT_THAT(regions[1].holes, ElementsAre(2));
}

TEST(FindRegions, holes_run_against_their_outline_even_if_loops_cross) {
  for (int seed = 0; seed < case_count(2000); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    std::vector<FlatLoop> loops(2 + random.index(6));
    for (FlatLoop& loop : loops)
      loop = star(random, 3 + random.index(8), {random.uniform(-1, 1), random.uniform(-1, 1)},
                  random.uniform(0.1, 2));
    for (const FlatRegion& region : find_regions(loops))
      for (const Index hole : region.holes)
        ASSERT_LT(area_of(loops[hole]) * area_of(loops[region.outline]), 0);
  }
}

TEST(FindRegions, leaves_out_loops_without_area) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(find_regions({}), IsEmpty());
  EXPECT_THAT(find_regions(std::vector<FlatLoop>{{},
                                                 {{1, 1}},
                                                 {{0, 0}, {1, 1}},
                                                 {{0, 0}, {0.1, 0.1}, {0.3, 0.3}},
                                                 {{0, 0}, {1, 0.3}, {2, 5}, {1, 0.3}},
                                                 {{0, 0}, {1, 0}, {nan, 1}},
                                                 {{2, 2}, {2, 2}, {2, 2}}}),
              IsEmpty());
  EXPECT_EQ(find_regions(std::vector<FlatLoop>{{{0, 0}, {1, 1}, {2, 2}}, {{0, 0}, {1, 0}, {0, 1}}})
                .size(),
            1u);
}

TEST(FindRegions, nests_loops_that_touch) {
  const FlatLoop square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const std::vector<FlatLoop> loops{
      square, {{0, 0}, {1, 2}, {2, 1}}, {{4, 1}, {5, 1}, {5, 2}, {4, 2}}, {{0, 2}, {0, 4}, {2, 3}}};
  const auto regions = find_regions(loops);
  ASSERT_EQ(regions.size(), 2u);
  EXPECT_THAT(regions[0].holes, ElementsAre(1, 3));
  EXPECT_EQ(regions[1].outline, 2u);
  const auto twice = find_regions(std::vector<FlatLoop>{square, square});
  EXPECT_EQ(twice.size(), 2u);
  EXPECT_FALSE(
      triangulate(std::vector<FlatLoop>{square, square}, FlatRegion{0, {1}}, InnerPoints::graded));
}

TEST(Triangulate, random_nested_regions) {
  std::size_t inner = 0;
  for (int seed = 0; seed < case_count(150) && !testing::Test::HasFatalFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const auto loops = random_nested(random);
    inner += expect_regions_triangulate(loops);
  }
  EXPECT_GT(inner, 1000u);
}

TEST(Triangulate, spirals_combs_grids_and_letters) {
  for (const int parts : {1, 2, 3, 7}) {
    SCOPED_TRACE(parts);
    for (const auto& letter : letters()) {
      std::vector<FlatLoop> loops;
      for (const FlatLoop& loop : letter) loops.push_back(refined(loop, parts));
      expect_regions_triangulate(loops);
      for (FlatLoop& loop : loops)
        for (Vec2d& p : loop)
          p = {0.8 * p.x() - 0.6 * p.y() + 1e6,
               0.6 * p.x() + 0.8 * p.y()};  // lines that rounding bends
      expect_regions_triangulate(loops);
    }
    expect_regions_triangulate({refined(spiral(5, 24, 0.5), parts)});
    expect_regions_triangulate({refined(spiral(3, 11, 1e-6), parts)});
    expect_regions_triangulate({refined(comb(20, 30), parts)});
    expect_regions_triangulate({refined(comb(50, 1e4), parts)});
    expect_regions_triangulate(grid_of_holes(6, parts));
  }
}

TEST(Triangulate, slivers_and_points_almost_on_one_line) {
  for (const double height : {1e-3, 1e-9, 1e-12, 1e-15, 1e-30}) {
    SCOPED_TRACE(height);
    expect_regions_triangulate({{{0, 0}, {1, 0}, {0.5, height}}});
    expect_regions_triangulate({{{0, 0}, {0.3, 0}, {1, 0}, {0.7, height}, {0.2, height}}});
    Random random(7);
    FlatLoop wave;  // above the x axis by no more than the height
    for (int i = 0; i <= 100; ++i) wave.emplace_back(0.01 * i, -height * random.uniform(0, 1));
    for (int i = 100; i >= 0; --i) wave.emplace_back(0.01 * i, height * random.uniform(0.1, 1));
    expect_regions_triangulate({wave});
  }
  FlatLoop fan;  // long edges whose ends are close together
  for (int i = 0; i < 40; ++i)
    fan.insert(fan.end(), {{1e-9 * i, 0}, {0.5 * i - 10, 10}, {1e-9 * i + 5e-10, 1e-6}});
  const auto mesh = triangulate(std::vector<FlatLoop>{fan}, {0, {}}, InnerPoints::graded);
  if (mesh) expect_constrained_delaunay(std::vector<FlatLoop>{fan}, {0, {}}, *mesh);
}

TEST(Triangulate, long_edges_across_many_points) {
  // A zigzag of fine teeth on both sides of a channel with long edges, each of which crosses
  // hundreds of edges when it is inserted.
  for (const int count : {10, 300}) {
    std::vector<FlatLoop> loops{{{-1, -1}, {count + 1.0, -1}, {count + 1.0, 1}, {-1, 1}}};
    FlatLoop needle{{-0.5, 0}, {count + 0.5, 1e-4}, {count + 0.5, 2e-4}};
    loops.push_back(needle);
    for (int i = 0; i < count; ++i) {
      const double x = i + 0.3 * (i % 3);
      loops.push_back({{x, -0.01}, {x + 0.1, -0.3}, {x - 0.1, -0.4}});
      loops.push_back({{x, 0.01}, {x + 0.1, 0.3}, {x - 0.1, 0.4}});
    }
    expect_regions_triangulate(loops);
  }
}

TEST(Triangulate, self_crossing_loops_give_nothing_or_a_triangulation) {
  int made = 0, refused = 0;
  for (int seed = 0; seed < case_count(3000) && !testing::Test::HasFatalFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    std::vector<FlatLoop> loops(1 + random.index(3));
    const bool on_grid = random.index(2) == 0;  // points that repeat, edges that touch and overlap
    for (FlatLoop& loop : loops) {
      const std::uint32_t count = random.index(9);
      for (std::uint32_t i = 0; i < count; ++i)
        loop.push_back(on_grid ? Vec2d{1.0 * random.index(5), 1.0 * random.index(5)}
                               : Vec2d{random.uniform(0, 1), random.uniform(0, 1)});
    }
    auto regions = find_regions(loops);
    for (Index i = 0; i < loops.size(); ++i) regions.push_back({i, {}});
    if (loops.size() == 3) regions.push_back({2, {0, 1}});
    for (const FlatRegion& region : regions) {
      const auto mesh = triangulate(loops, region,
                                    random.index(2) == 0 ? InnerPoints::none : InnerPoints::graded);
      (mesh ? made : refused) += 1;
      if (mesh && std::abs(area_of(loops[region.outline])) > 0) {
        const double outline = std::abs(area_of(loops[region.outline]));
        const bool is_nested =
            std::all_of(region.holes.begin(), region.holes.end(),
                        [&](Index hole) { return std::abs(area_of(loops[hole])) < outline; });
        if (is_nested) expect_constrained_delaunay(loops, region, *mesh);
      }
    }
  }
  EXPECT_GT(made, 1000);
  EXPECT_GT(refused, 1000);
}

TEST(Triangulate, refuses_loops_that_cannot_be_triangulated) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  const FlatLoop square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const std::vector<std::vector<FlatLoop>> bad{
      {{}},
      {{{0, 0}}},
      {{{0, 0}, {1, 0}}},
      {{{0, 0}, {1, 0}, {2, 0}, {1.5, 0}}},
      {{{0, 0}, {0, 0}, {0, 0}}},
      {{{0, 0}, {1, 0}, {1, 0}, {0, 1}}},
      {{{0, 0}, {2, 2}, {2, 0}, {0, 2}}},          // a bow tie
      {{{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}},  // touches itself
      {{{0, 0}, {1, 0}, {nan, 1}}},
      {{{0, 0}, {1, 0}, {infinity, 1}}},
      {{{0, 0}, {1e70, 0}, {0, 1e70}}},
      {square, {{0, 0}, {2, 1}, {1, 2}}},  // a hole that touches a corner
      {square, {{2, 0}, {3, 1}, {1, 1}}},  // a hole at an edge
      {square, {{1, 1}, {3, 1}, {2, 5}}},  // a hole that crosses
      {square, {{5, 5}, {6, 5}, {5, 6}}},  // a hole next to it
      {square, {{1, 1}, {2, 1}, {1, 2}}, {{1.1, 1.1}, {1.2, 1.1}, {1.1, 1.2}}},  // a hole in a hole
  };
  for (std::size_t i = 0; i < bad.size(); ++i) {
    SCOPED_TRACE(i);
    FlatRegion region;
    for (Index hole = 1; hole < bad[i].size(); ++hole) region.holes.push_back(hole);
    for (const InnerPoints inner : {InnerPoints::none, InnerPoints::graded})
      EXPECT_FALSE(triangulate(bad[i], region, inner));
  }
  EXPECT_FALSE(triangulate({}, {}, InnerPoints::graded));
  EXPECT_FALSE(triangulate(std::vector<FlatLoop>{square}, {0, {1}}, InnerPoints::graded));
}

/// The smallest angles of the triangles with an inner point, degrees, ascending.
std::vector<double> inner_angles(std::span<const Vec2d> points, Index rim, const FlatMesh& mesh) {
  std::vector<double> angles;
  for (const auto& t : mesh.triangles) {
    if (std::ranges::all_of(t, [&](Index p) { return p < rim; })) continue;
    double least = 180;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2d ab = points[t[(k + 1) % 3]] - points[t[k]],
                  ac = points[t[(k + 2) % 3]] - points[t[k]];
      least = std::min(least, std::atan2(std::abs(ab.x() * ac.y() - ab.y() * ac.x()), ab.dot(ac)));
    }
    angles.push_back(least * 180 / std::numbers::pi);
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

TEST(Triangulate, inner_points_are_sparser_inwards) {
  for (const Index count : {40u, 100u, 1000u, 4000u}) {
    SCOPED_TRACE(count);
    std::vector<FlatLoop> disc(1);
    for (Index i = 0; i < count; ++i) disc[0].push_back(polar(2 * std::numbers::pi * i / count, 1));
    const auto mesh = triangulate(disc, {0, {}}, InnerPoints::graded);
    ASSERT_TRUE(mesh);
    expect_constrained_delaunay(disc, {0, {}}, *mesh);
    // A uniform spacing would take count^2 / 4 pi / 0.87 points.
    EXPECT_LT(mesh->inner.size(), 1.5 * count);
    EXPECT_GT(mesh->inner.size(), 0.25 * count);
    const auto points = all_points(disc, {0, {}}, *mesh);
    EXPECT_GT(inner_angles(points, count, *mesh).front(), 14);
    const double rim_spacing = 2 * std::numbers::pi / count;
    for (const auto& t : mesh->triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const double depth = std::max(0.0, 1 - points[t[k]].norm());
        EXPECT_LT((points[t[k]] - points[t[(k + 1) % 3]]).norm(), 4 * rim_spacing + 2 * depth);
      }
  }
}

TEST(Triangulate, short_edges_make_no_slivers) {
  // Where a plane passes a vertex of the surface at a small distance, two edges of the rim are as
  // short.
  Random random(5);
  for (const double shortest : {2e-2, 1e-2}) {
    SCOPED_TRACE(shortest);
    constexpr Index kEdges = 200;
    std::vector<FlatLoop> disc(1);
    const double step = 2 * std::numbers::pi / kEdges;
    for (Index i = 0; i < kEdges; ++i) {
      disc[0].push_back(polar(i * step, 1));
      if (i % 10 != 0) continue;
      const double length = step * random.uniform(0.5, 1) * shortest;
      disc[0].push_back(polar(i * step + length, 1));
      disc[0].push_back(polar(i * step + 2 * length, 1));
    }
    const auto rim = static_cast<Index>(disc[0].size());
    const auto mesh = triangulate(disc, {0, {}}, InnerPoints::graded);
    ASSERT_TRUE(mesh);
    expect_constrained_delaunay(disc, {0, {}}, *mesh);
    expect_inner_points_in_place(disc, {0, {}}, *mesh);
    EXPECT_LT(mesh->inner.size(), 2 * rim);
    EXPECT_GT(inner_angles(all_points(disc, {0, {}}, *mesh), rim, *mesh).front(), 1.2);
  }
}

TEST(Triangulate, thin_and_tiny_regions_get_no_inner_points) {
  const std::vector<FlatLoop> strip{refined({{0, 0}, {30, 0}, {30, 0.5}, {0, 0.5}}, 30)};
  const auto mesh = triangulate(strip, {0, {}}, InnerPoints::graded);
  ASSERT_TRUE(mesh);
  EXPECT_THAT(mesh->inner, IsEmpty());
  std::vector<FlatLoop> far{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (Vec2d& p : far[0]) p = 1e-15 * p + Vec2d(1, 1);
  const auto tiny = triangulate(far, {0, {}}, InnerPoints::graded);
  if (tiny) expect_constrained_delaunay(far, {0, {}}, *tiny);
}

TEST(Triangulate, uses_the_given_memory_alone) {
  std::pmr::monotonic_buffer_resource memory;
  Random random(3);
  std::vector<FlatLoop> loops{star(random, 200, {0, 0}, 1)};
  const auto expected = triangulate(loops, {0, {}}, InnerPoints::graded);
  std::pmr::memory_resource* const usual =
      std::pmr::set_default_resource(std::pmr::null_memory_resource());
  const auto mesh = triangulate(loops, {0, {}}, InnerPoints::graded, memory);
  std::pmr::set_default_resource(usual);
  ASSERT_TRUE(mesh && expected);
  EXPECT_EQ(mesh->inner, expected->inner);
  EXPECT_EQ(mesh->triangles, expected->triangles);
}

TEST(Triangulate, thousands_of_points_take_no_time) {
  for (const std::uint32_t count : {1000u, 10000u}) {
    Random random(count);
    std::vector<FlatLoop> star_loop{star(random, count, {0, 0}, 1)};
    const std::vector<std::pair<const char*, std::vector<FlatLoop>>> cases{
        {"star", star_loop},
        {"spiral", {spiral(10, static_cast<int>(count) / 20, 0.5)}},
        {"comb", {comb(static_cast<int>(count) / 4, 50)}},
        {"square", {refined({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, static_cast<int>(count) / 4)}},
        {"grid of holes", grid_of_holes(static_cast<int>(std::sqrt(count / 4)), 1)}};
    for (const auto& [name, loops] : cases) {
      SCOPED_TRACE(name);
      const auto start = std::chrono::steady_clock::now();
      const auto regions = find_regions(loops);
      const auto found = std::chrono::steady_clock::now();
      ASSERT_EQ(regions.size(), 1u);
      const auto mesh = triangulate(loops, regions[0], InnerPoints::graded);
      const auto triangulated = std::chrono::steady_clock::now();
      ASSERT_TRUE(mesh);
      const auto points = all_points(loops, regions[0], *mesh);
      const Index rim = rim_count(loops, regions[0]);
      std::vector<double> values(4 * points.size());
      for (Index i = 0; i < rim; ++i) {
        values[4 * i] = points[i].x();
        values[4 * i + 1] = points[i].y();
      }
      extend_harmonically(points, *mesh, 4, values);
      const auto end = std::chrono::steady_clock::now();
      const auto milliseconds = [](auto duration) {
        return std::chrono::duration<double, std::milli>(duration).count();
      };
      if (std::getenv("SUNDER_STRESS") != nullptr)
        std::printf("%s, %u rim points, %zu inner: regions %.1f, triangles %.1f, values %.1f ms\n",
                    name, rim, mesh->inner.size(), milliseconds(found - start),
                    milliseconds(triangulated - found), milliseconds(end - triangulated));
      EXPECT_LT(milliseconds(end - start),
                10000);  // a guard against quadratic time, generous to sanitizers
      expect_constrained_delaunay(loops, regions[0], *mesh);
    }
  }
}

TEST(ExtendHarmonically, reproduces_linear_functions_within_the_values_of_the_rim) {
  std::size_t inner = 0;
  for (int seed = 0; seed < case_count(100); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const auto loops = random_nested(random);
    for (const FlatRegion& region : find_regions(loops)) {
      const FlatLoop& outline = loops[region.outline];
      const double size = (outline[0] - outline[outline.size() / 2]).norm();
      const auto mesh = triangulate(loops, region, InnerPoints::graded);
      ASSERT_TRUE(mesh);
      const auto points = all_points(loops, region, *mesh);
      const Index rim = rim_count(loops, region);
      const auto linear = [&](const Vec2d& p) {
        const Vec2d at = (p - outline[0]) / size;
        return at.x() - 2 * at.y() + 3;
      };
      std::vector<double> values(5 * points.size());
      for (Index i = 0; i < rim; ++i) {
        const double weight = random.uniform(0, 1);
        const std::array<double, 5> row{linear(points[i]), 1, weight, 1 - weight,
                                        random.index(2) * 1e3};
        std::ranges::copy(row, &values[5 * i]);
      }
      std::array<double, 5> least, greatest;
      for (std::size_t c = 0; c < 5; ++c) {
        least[c] = greatest[c] = values[c];
        for (Index i = 0; i < rim; ++i) {
          least[c] = std::min(least[c], values[5 * i + c]);
          greatest[c] = std::max(greatest[c], values[5 * i + c]);
        }
      }
      extend_harmonically(points, *mesh, 5, values);
      inner += mesh->inner.size();
      for (std::size_t i = rim; i < points.size(); ++i) {
        const double* const row = &values[5 * i];
        ASSERT_NEAR(row[0], linear(points[i]), 1e-9);
        ASSERT_EQ(row[1], 1);
        ASSERT_NEAR(row[2] + row[3], 1, 1e-10);
        for (std::size_t c = 0; c < 5; ++c) {
          ASSERT_GE(row[c], least[c]);
          ASSERT_LE(row[c], greatest[c]);
        }
      }
    }
  }
  EXPECT_GT(inner, 1000u);
}

TEST(ExtendHarmonically, is_harmonic) {
  for (int seed = 0; seed < case_count(20); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const auto loops = random_nested(random);
    for (const FlatRegion& region : find_regions(loops)) {
      const auto mesh = triangulate(loops, region, InnerPoints::graded);
      ASSERT_TRUE(mesh);
      const auto points = all_points(loops, region, *mesh);
      const Index rim = rim_count(loops, region);
      std::vector<double> values(points.size()), sums(points.size(), 0), weights(points.size(), 0);
      for (Index i = 0; i < rim; ++i) values[i] = random.uniform(0, 1);
      extend_harmonically(points, *mesh, 1, values);
      for (const auto& t : mesh->triangles)
        for (std::size_t k = 0; k < 3; ++k) {
          const Index a = t[k], b = t[(k + 1) % 3];
          const Vec2d to_a = points[a] - points[t[(k + 2) % 3]],
                      to_b = points[b] - points[t[(k + 2) % 3]];
          const double cotangent = to_a.dot(to_b) / (to_a.x() * to_b.y() - to_a.y() * to_b.x());
          for (const auto& [at, from] : {std::pair{a, b}, std::pair{b, a}}) {
            weights[at] += cotangent;
            sums[at] += cotangent * values[from];
          }
        }
      for (std::size_t i = rim; i < points.size(); ++i)
        ASSERT_NEAR(values[i], sums[i] / weights[i], 1e-9);
    }
  }
}

TEST(ExtendHarmonically, gives_no_rows_without_inner_points) {
  const std::vector<FlatLoop> loops{{{0, 0}, {1, 0}, {0, 1}}};
  const auto mesh = triangulate(loops, {0, {}}, InnerPoints::none);
  ASSERT_TRUE(mesh);
  std::vector<double> values(6, 1.0);
  extend_harmonically(loops[0], *mesh, 2, values);
  EXPECT_THAT(values, testing::Each(1.0));
}

}  // namespace
}  // namespace sunder::tear
