// Loops nest into regions.
#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/stress.h"
#include "support/models/flat_loops.h"
#include "tear/section/flat_section.h"

namespace sunder::tear {
namespace {

using test::Random;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(FindRegions, alternates_outlines_and_holes) {
  const auto square = [](double x, double half) {
    return FlatLoop{{x - half, -half}, {x + half, -half}, {x + half, half}, {x - half, half}};
  };
  const auto loops = test::alternated({square(0, 1), square(0, 5), square(0, 3), square(0, 2),
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
  for (int seed = 0; seed < test::stressed(200, 20); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const auto loops = test::random_nested(random);
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
      for (const FlatLoop& loop : loops) parity ^= test::is_inside(loop, p) ? 1 : 0;
      for (const FlatRegion& region : regions)
        covered += test::is_inside(loops[region.outline], p) &&
                   std::none_of(region.holes.begin(), region.holes.end(),
                                [&](Index hole) { return test::is_inside(loops[hole], p); });
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
  for (int seed = 0; seed < test::stressed(2000, 20); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    std::vector<FlatLoop> loops(2 + random.index(6));
    for (FlatLoop& loop : loops)
      loop = test::star(random, 3 + random.index(8), {random.uniform(-1, 1), random.uniform(-1, 1)},
                        random.uniform(0.1, 2));
    for (const FlatRegion& region : find_regions(loops))
      for (const Index hole : region.holes)
        ASSERT_LT(test::area_of(loops[hole]) * test::area_of(loops[region.outline]), 0);
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
}
}  // namespace
}  // namespace sunder::tear
