#include "tear/filling/part_points.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/internal/ordered.h"
#include "support/machine/random.h"

namespace sunder::tear {
namespace {

using test::Random;

constexpr double kClose = 1e-4;

/// A square whose lower side has runs of points that rounding may have put in any order.
FlatLoop square_with_runs(Random& random, std::uint32_t runs, std::uint32_t points_of_run) {
  FlatLoop loop = {Vec2d(0, 0)};
  for (std::uint32_t run = 0; run < runs; ++run) {
    const double middle = (run + 0.5) / runs;
    for (std::uint32_t i = 0; i < points_of_run; ++i)
      loop.emplace_back(middle + random.uniform(-0.3, 0.3) * kClose, 0);
  }
  loop.emplace_back(1, 0);
  loop.emplace_back(1, 1);
  loop.emplace_back(0, 1);
  return loop;
}

double area_of(const FlatLoop& loop) {
  double twice = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

TEST(PartPoints, close_points_are_put_in_the_order_of_the_loop) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const std::uint32_t runs = 1 + random.index(4), points = 2 + random.index(4);
    FlatLoop loop = square_with_runs(random, runs, points);
    const FlatLoop before = loop;
    // Any point of a loop may be its first one.
    const auto turn = static_cast<std::ptrdiff_t>(random.index(std::uint32_t(loop.size())));
    std::rotate(loop.begin(), loop.begin() + turn, loop.end());
    ASSERT_TRUE(part_close_points(loop, kClose));
    std::rotate(loop.begin(), loop.end() - turn, loop.end());
    ASSERT_EQ(loop.size(), before.size());
    EXPECT_NEAR(area_of(loop), 1, 1e-12);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      EXPECT_LT(norm(Vec2d(loop[i] - before[i])), 3 * kClose);
      if (i + 4 < loop.size()) {
        EXPECT_GT(loop[i + 1].x(), loop[i].x()) << "point " << i << ", seed " << seed;
      }
    }
  }
}

TEST(PartPoints, loops_whose_points_are_apart_stay_as_they_are) {
  FlatLoop loop = {Vec2d(0, 0), Vec2d(2 * kClose, 0), Vec2d(1, 0), Vec2d(1, 1), Vec2d(0, 1)};
  const FlatLoop before = loop;
  EXPECT_FALSE(part_close_points(loop, kClose));
  EXPECT_EQ(loop, before);
}

TEST(PartPoints, loops_without_room_stay_as_they_are) {
  // All points are close; or those before and after a run are hardly farther away than its points.
  for (const double room : {0.1, 2.0}) {
    FlatLoop loop = {Vec2d(0, 0), Vec2d(0.5 * kClose, 0), Vec2d(room * kClose, room * kClose)};
    const FlatLoop before = loop;
    EXPECT_FALSE(part_close_points(loop, kClose)) << room;
    EXPECT_EQ(loop, before) << room;
  }
}

TEST(PartPoints, a_loop_that_passes_a_place_twice_is_parted_into_the_section) {
  // Two squares that touch in a corner, as one loop around both.
  const Vec2d waist(1, 1);
  FlatLoop loop = {Vec2d(0, 0), Vec2d(1, 0), waist, Vec2d(2, 1),
                   Vec2d(2, 2), Vec2d(1, 2), waist, Vec2d(0, 1)};
  const FlatLoop before = loop;
  ScratchMemory scratch;
  part_touching_points(loop, scratch);
  EXPECT_NE(loop[2], loop[6]);
  for (const std::size_t i : {2u, 6u}) {
    const double move = norm(Vec2d(loop[i] - waist));
    EXPECT_GT(move, 0);
    EXPECT_LT(move, 1e-6);
    loop[i] = waist;
  }
  EXPECT_EQ(loop, before) << "other points stay where they are";
}

}  // namespace
}  // namespace sunder::tear
