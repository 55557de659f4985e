// Flat regions of all shapes, random and degenerate: the result is a constrained Delaunay
// triangulation or nothing.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/stress.h"
#include "support/models/flat_loops.h"
#include "support/oracles/flat_meshes.h"
#include "tear/section/flat_section.h"

namespace sunder::tear {
namespace {

using test::Random;
using testing::IsEmpty;

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
      test::expect_constrained_delaunay(loops, region, *mesh);
      test::expect_inner_points_in_place(loops, region, *mesh);
      if (wanted == InnerPoints::none) {
        EXPECT_THAT(mesh->inner, IsEmpty());
      }
      inner += mesh->inner.size();
    }
  return inner;
}
TEST(Triangulate, random_nested_regions) {
  std::size_t inner = 0;
  for (int seed = 0; seed < test::stressed(150, 20) && !testing::Test::HasFatalFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const auto loops = test::random_nested(random);
    inner += expect_regions_triangulate(loops);
  }
  EXPECT_GT(inner, 1000u);
}

TEST(Triangulate, spirals_combs_grids_and_letters) {
  for (const int parts : {1, 2, 3, 7}) {
    SCOPED_TRACE(parts);
    for (const auto& letter : test::letters()) {
      std::vector<FlatLoop> loops;
      for (const FlatLoop& loop : letter) loops.push_back(test::refined(loop, parts));
      expect_regions_triangulate(loops);
      for (FlatLoop& loop : loops)
        for (Vec2d& p : loop)
          p = {0.8 * p.x() - 0.6 * p.y() + 1e6,
               0.6 * p.x() + 0.8 * p.y()};  // lines that rounding bends
      expect_regions_triangulate(loops);
    }
    expect_regions_triangulate({test::refined(test::spiral(5, 24, 0.5), parts)});
    expect_regions_triangulate({test::refined(test::spiral(3, 11, 1e-6), parts)});
    expect_regions_triangulate({test::refined(test::comb(20, 30), parts)});
    expect_regions_triangulate({test::refined(test::comb(50, 1e4), parts)});
    expect_regions_triangulate(test::grid_of_holes(6, parts));
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
  if (mesh) test::expect_constrained_delaunay(std::vector<FlatLoop>{fan}, {0, {}}, *mesh);
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
  for (int seed = 0; seed < test::stressed(3000, 20) && !testing::Test::HasFatalFailure(); ++seed) {
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
      if (mesh && std::abs(test::area_of(loops[region.outline])) > 0) {
        const double outline = std::abs(test::area_of(loops[region.outline]));
        const bool is_nested =
            std::all_of(region.holes.begin(), region.holes.end(),
                        [&](Index hole) { return std::abs(test::area_of(loops[hole])) < outline; });
        if (is_nested) test::expect_constrained_delaunay(loops, region, *mesh);
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
    for (Index i = 0; i < count; ++i)
      disc[0].push_back(test::polar(2 * std::numbers::pi * i / count, 1));
    const auto mesh = triangulate(disc, {0, {}}, InnerPoints::graded);
    ASSERT_TRUE(mesh);
    test::expect_constrained_delaunay(disc, {0, {}}, *mesh);
    // A uniform spacing would take count^2 / 4 pi / 0.87 points.
    EXPECT_LT(mesh->inner.size(), 1.5 * count);
    EXPECT_GT(mesh->inner.size(), 0.25 * count);
    const auto points = test::all_points(disc, {0, {}}, *mesh);
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
      disc[0].push_back(test::polar(i * step, 1));
      if (i % 10 != 0) continue;
      const double length = step * random.uniform(0.5, 1) * shortest;
      disc[0].push_back(test::polar(i * step + length, 1));
      disc[0].push_back(test::polar(i * step + 2 * length, 1));
    }
    const auto rim = static_cast<Index>(disc[0].size());
    const auto mesh = triangulate(disc, {0, {}}, InnerPoints::graded);
    ASSERT_TRUE(mesh);
    test::expect_constrained_delaunay(disc, {0, {}}, *mesh);
    test::expect_inner_points_in_place(disc, {0, {}}, *mesh);
    EXPECT_LT(mesh->inner.size(), 2 * rim);
    EXPECT_GT(inner_angles(test::all_points(disc, {0, {}}, *mesh), rim, *mesh).front(), 1.2);
  }
}

TEST(Triangulate, thin_and_tiny_regions_get_no_inner_points) {
  const std::vector<FlatLoop> strip{test::refined({{0, 0}, {30, 0}, {30, 0.5}, {0, 0.5}}, 30)};
  const auto mesh = triangulate(strip, {0, {}}, InnerPoints::graded);
  ASSERT_TRUE(mesh);
  EXPECT_THAT(mesh->inner, IsEmpty());
  std::vector<FlatLoop> far{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (Vec2d& p : far[0]) p = 1e-15 * p + Vec2d(1, 1);
  const auto tiny = triangulate(far, {0, {}}, InnerPoints::graded);
  if (tiny) test::expect_constrained_delaunay(far, {0, {}}, *tiny);
}

TEST(Triangulate, uses_the_given_memory_alone) {
  std::pmr::monotonic_buffer_resource memory;
  Random random(3);
  std::vector<FlatLoop> loops{test::star(random, 200, {0, 0}, 1)};
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
    std::vector<FlatLoop> star_loop{test::star(random, count, {0, 0}, 1)};
    const std::vector<std::pair<const char*, std::vector<FlatLoop>>> cases{
        {"star", star_loop},
        {"spiral", {test::spiral(10, static_cast<int>(count) / 20, 0.5)}},
        {"comb", {test::comb(static_cast<int>(count) / 4, 50)}},
        {"square", {test::refined({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, static_cast<int>(count) / 4)}},
        {"grid of holes", test::grid_of_holes(static_cast<int>(std::sqrt(count / 4)), 1)}};
    for (const auto& [name, loops] : cases) {
      SCOPED_TRACE(name);
      const auto start = std::chrono::steady_clock::now();
      const auto regions = find_regions(loops);
      const auto found = std::chrono::steady_clock::now();
      ASSERT_EQ(regions.size(), 1u);
      const auto mesh = triangulate(loops, regions[0], InnerPoints::graded);
      const auto triangulated = std::chrono::steady_clock::now();
      ASSERT_TRUE(mesh);
      const auto points = test::all_points(loops, regions[0], *mesh);
      const Index rim = test::rim_count(loops, regions[0]);
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
      test::expect_constrained_delaunay(loops, regions[0], *mesh);
    }
  }
}
}  // namespace
}  // namespace sunder::tear
