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

/// Where there is no doubt, nothing is measured anew.
const RefitBounds::MeasureChanges kMeasuresNothing = [](std::span<const std::size_t> points,
                                                        std::size_t) {
  ADD_FAILURE() << "measured without need";
  return std::vector<double>(points.size(), 0.0);
};

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
    EXPECT_TRUE(points.bounds->tighten(kMeasuresNothing).empty()) << "nothing is worse";
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

TEST(RefitBounds, a_loss_that_the_next_smaller_slacks_allow_is_reduced_too) {
  // 9 % more is less than the second slack and more than none.
  constexpr Index kOperations[] = {0, 0};
  RefitBounds bounds(1, kOperations);
  for (const std::size_t point : {0u, 1u}) bounds.set_barycentric(point, 0, 1, kRounding);
  bounds.begin();
  for (const std::size_t point : {0u, 1u}) bounds.of_fit(point)[0] = 1.09;
  EXPECT_EQ(bounds.tighten(kMeasuresNothing), (std::vector<std::size_t>{0, 1}));
  for (const std::size_t point : {0u, 1u}) {
    EXPECT_LT(bounds.allowed(point)[0], 1.09);
    bounds.of_fit(point)[0] = bounds.allowed(point)[0];
  }
  EXPECT_TRUE(bounds.tighten(kMeasuresNothing).empty());
}

TEST(RefitBounds, only_as_many_points_are_tightened_as_lose_too_much) {
  constexpr Index kOperations[] = {0, 0, 0};
  RefitBounds bounds(1, kOperations);
  for (const std::size_t point : {0u, 1u, 2u}) bounds.set_barycentric(point, 0, 1, kRounding);
  bounds.begin();
  bounds.of_fit(0)[0] = 0.5;
  bounds.of_fit(1)[0] = 1.04;
  bounds.of_fit(2)[0] = 1.35;
  EXPECT_EQ(bounds.tighten(kMeasuresNothing), std::vector<std::size_t>{2})
      << "0.04 is within a tenth of 0.5";
}

TEST(RefitBounds, a_point_that_loses_within_rounding_alone_is_kept_if_nothing_makes_up_for_it) {
  constexpr Index kOperations[] = {0, 0};
  RefitBounds bounds(1, kOperations);
  bounds.set_barycentric(0, 0, 1, kRounding);
  bounds.set_barycentric(1, 0, 0, kRounding);
  bounds.begin();
  bounds.of_fit(1)[0] = kRounding;
  EXPECT_EQ(bounds.tighten(kMeasuresNothing), std::vector<std::size_t>{1});
  EXPECT_TRUE(bounds.is_kept(1));
  EXPECT_FALSE(bounds.is_kept(0));
  bounds.of_fit(1)[0] = 0;
  EXPECT_TRUE(bounds.tighten(kMeasuresNothing).empty());
  bounds.of_fit(0)[0] = 0.5;
  bounds.of_fit(1)[0] = kRounding;
  EXPECT_TRUE(bounds.tighten(kMeasuresNothing).empty()) << "now something does";
}

TEST(RefitBounds, where_rounding_decides_whether_points_lose_the_posed_points_do) {
  constexpr Index kOperations[] = {0, 0, 0};
  RefitBounds bounds(1, kOperations);
  for (const std::size_t point : {0u, 1u, 2u}) bounds.set_barycentric(point, 0, 1, kRounding);
  bounds.begin();
  for (const std::size_t point : {0u, 1u, 2u}) {
    bounds.of_fit(point)[0] = 1;
    bounds.doubt(point)[0] = 1e-4;
  }
  const auto changes = [](double a, double b, double c) {
    return [=](std::span<const std::size_t> points, std::size_t) {
      EXPECT_EQ(points.size(), 3u);
      return std::vector{a, b, c};
    };
  };
  EXPECT_TRUE(bounds.tighten(changes(5e-5, -6e-5, 1e-6)).empty()) << "together they gain";
  EXPECT_EQ(bounds.tighten(changes(5e-5, -4e-5, 6e-5)), std::vector<std::size_t>({0, 2}));
  EXPECT_TRUE(bounds.is_kept(0) && bounds.is_kept(2));
  EXPECT_FALSE(bounds.is_kept(1));
}

TEST(RefitBounds, fits_that_use_all_they_are_allowed_end_up_worse_over_no_group) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Points points(seed);
    RefitBounds& bounds = *points.bounds;
    // Each fit takes a random part of what is allowed: of the slack if there is any. Every tenth
    // is given up at once, as by a certificate.
    const auto fit = [&](std::size_t point) {
      if (points.random.index(10) == 0) bounds.keep(point);
      for (std::size_t group = 0; group < kGroups; ++group)
        bounds.of_fit(point)[group] =
            bounds.is_kept(point)
                ? bounds.barycentric(point)[group]
                : bounds.allowed(point)[group] * (group == 0 ? 1.0 : points.random.uniform(0.5, 1));
    };
    std::vector<std::size_t> open(kPoints);
    std::iota(open.begin(), open.end(), 0u);
    int rounds = 0;
    for (; !open.empty(); open = bounds.tighten(kMeasuresNothing), ++rounds) {
      ASSERT_LT(rounds, static_cast<int>(3 * kPoints * kGroups));
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
        EXPECT_LE(after, std::max(before, kPoints * kRounding)) << "seed " << seed;
      }
  }
}

}  // namespace
}  // namespace sunder::tear
