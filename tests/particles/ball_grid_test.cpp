#include "particles/contact/ball_grid.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder::particles {
namespace {

Vec3d any_place(test::Random& random, const Vec3d& extent) {
  return {extent.x() * random.uniform(-1, 1), extent.y() * random.uniform(-1, 1),
          extent.z() * random.uniform(-1, 1)};
}

/// Every ball within the reach is found, none twice.
void expect_all_found(const BallGrid& grid, const std::vector<Ball>& balls, const Vec3d& at,
                      double reach) {
  std::vector<int> times(balls.size(), 0);
  grid.for_each_near(at, [&](const Ball& ball) {
    ++times[ball.particle];
    EXPECT_EQ(ball.at, balls[ball.particle].at);
  });
  for (std::size_t i = 0; i < balls.size(); ++i) {
    EXPECT_LE(times[i], 1);
    const bool is_within = (balls[i].at - at).norm() <= reach;
    EXPECT_GE(times[i], is_within ? 1 : 0) << i;
  }
}

TEST(ball_grid, finds_all_within_reach_in_random_clouds) {
  test::Random random(7);
  BallGrid grid;
  for (int round = 0; round < 60; ++round) {
    // Solids, sheets, lines and points.
    Vec3d extent = Vec3d::Ones();
    for (int axis = 0; axis < round % 4; ++axis) extent[axis] = 0;
    std::vector<Ball> balls;
    const int count = static_cast<int>(random.uniform(1, 300));
    for (int i = 0; i < count; ++i)
      balls.push_back({.at = any_place(random, extent), .particle = static_cast<Index>(i)});
    if (round % 3 == 0) balls[0].at = any_place(random, Vec3d::Constant(1e9));
    const double reach = random.uniform(0.01, 0.7);
    grid.fill(balls, reach);
    for (int i = 0; i < 30; ++i)
      expect_all_found(grid, balls, any_place(random, Vec3d::Constant(1.5)), reach);
    for (const Ball& ball : balls) expect_all_found(grid, balls, ball.at, reach);
  }
}

TEST(ball_grid, balls_at_exactly_the_reach_are_found) {
  std::vector<Ball> balls;
  for (Index i = 0; i < 100; ++i) balls.push_back({.at = Vec3d(0.1 * i, 0, 0), .particle = i});
  BallGrid grid;
  grid.fill(balls, 0.1);
  for (Index i = 1; i + 1 < 100; ++i) {
    std::vector<Index> found;
    grid.for_each_near(balls[i].at, [&](const Ball& ball) { found.push_back(ball.particle); });
    for (const Index other : {i - 1, i, i + 1})
      EXPECT_EQ(std::count(found.begin(), found.end(), other), 1) << i;
    EXPECT_LE(found.size(), 6u);
  }
}

TEST(ball_grid, far_balls_take_no_more_cells) {
  std::vector<Ball> balls(3);
  balls[1].at = {1e12, -1e12, 1e12};
  balls[2].at = {-1e30, 0, 1};
  BallGrid grid;
  grid.fill(balls, 1e-3);
  EXPECT_LT(grid.memory_bytes(), 1000u);
  grid.fill({}, 1);
  grid.for_each_near(Vec3d::Zero(), [](const Ball&) { ADD_FAILURE(); });
}

}  // namespace
}  // namespace sunder::particles
