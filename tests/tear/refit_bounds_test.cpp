// Bounds of the fits of points, which are tightened until an operation is worse over no group.

#include "tear/weights/refit_bounds.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

namespace sunder::tear {
namespace {

constexpr std::size_t kPoints = 60, kGroups = 4;
constexpr double kRounding = 1e-12;

/// Random points of three operations; each tenth is exact over a group.
struct Points {
  explicit Points(std::uint64_t seed) : random(seed) {
    for (std::size_t point = 0; point < kPoints; ++point) operations.push_back(random.index(3) * 7);
    bounds.emplace(kGroups, operations);
    for (std::size_t point = 0; point < kPoints; ++point)
      for (std::size_t group = 0; group < kGroups; ++group) {
        squares.push_back(random.index(10) == 0 ? 0 : std::pow(10, random.uniform(-8, -2)));
        bounds->set_barycentric(point, group, squares.back(), kRounding);
      }
    bounds->begin();
  }

  test::Random random;
  std::vector<Index> operations;
  std::vector<double> squares;
  std::optional<RefitBounds> bounds;
};

TEST(RefitBounds, barycentric_weights_are_always_allowed) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Points points(seed);
    for (std::size_t point = 0; point < kPoints; ++point)
      for (std::size_t group = 0; group < kGroups; ++group) {
        EXPECT_GE(points.bounds->allowed(point)[group], points.squares[point * kGroups + group]);
        EXPECT_EQ(points.bounds->of_fit(point)[group], points.bounds->barycentric(point)[group]);
      }
    EXPECT_TRUE(points.bounds->tighten().empty()) << "nothing is worse";
  }
}

TEST(RefitBounds, where_barycentric_weights_are_exact_no_error_is_allowed) {
  Points points(1);
  int exact = 0;
  for (std::size_t point = 0; point < kPoints; ++point) {
    bool is_exact = false;
    for (std::size_t group = 0; group < kGroups; ++group)
      if (points.squares[point * kGroups + group] == 0) {
        EXPECT_EQ(points.bounds->allowed(point)[group], kRounding);
        is_exact = true;
      }
    EXPECT_EQ(points.bounds->is_exact(point), is_exact);
    exact += is_exact ? 1 : 0;
  }
  EXPECT_GT(exact, 3);
}

TEST(RefitBounds, fits_that_use_all_they_are_allowed_end_up_worse_over_no_group) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Points points(seed);
    RefitBounds& bounds = *points.bounds;
    // Each fit takes a random part of what is allowed: of the slack if there is any.
    const auto fit = [&](std::size_t point) {
      for (std::size_t group = 0; group < kGroups; ++group)
        bounds.of_fit(point)[group] =
            bounds.allowed(point)[group] * (group == 0 ? 1.0 : points.random.uniform(0.5, 1));
    };
    std::vector<std::size_t> open(kPoints);
    std::iota(open.begin(), open.end(), 0u);
    int rounds = 0;
    for (; !open.empty(); open = bounds.tighten(), ++rounds) {
      ASSERT_LT(rounds, 100);
      ASSERT_TRUE(std::ranges::is_sorted(open));
      for (const std::size_t point : open) fit(point);
    }
    EXPECT_GT(rounds, 1) << "over the first group all were worse at first";
    for (const Index operation : {0u, 7u, 14u})
      for (std::size_t group = 0; group < kGroups; ++group) {
        double before = 0, after = 0;
        for (std::size_t point = 0; point < kPoints; ++point) {
          if (points.operations[point] != operation) continue;
          before += bounds.barycentric(point)[group];
          after += bounds.of_fit(point)[group];
          EXPECT_LE(bounds.of_fit(point)[group], bounds.allowed(point)[group]);
        }
        EXPECT_LE(after, before * (1 + 1e-12));
      }
  }
}

}  // namespace
}  // namespace sunder::tear
