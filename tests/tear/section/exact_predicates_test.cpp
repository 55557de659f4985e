// Compares signs with integer arithmetic, on points that are on one line or circle within the last
// bit.
#include "tear/section/exact_predicates.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder::tear {
namespace {

using test::Random;

int sign(std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

/// The product of two integers of at most 62 bits as high * 2^62 + low, compared with another such
/// product.
int compare_products(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
  const auto split_product = [](std::int64_t x, std::int64_t y) {
    const bool negative = (x < 0) != (y < 0);
    const auto ux = static_cast<std::uint64_t>(x < 0 ? -x : x),
               uy = static_cast<std::uint64_t>(y < 0 ? -y : y);
    const std::uint64_t x1 = ux >> 31, x0 = ux & 0x7FFFFFFF, y1 = uy >> 31, y0 = uy & 0x7FFFFFFF;
    const std::uint64_t middle = x1 * y0 + x0 * y1;
    const std::uint64_t low = x0 * y0 + ((middle & 0x7FFFFFFF) << 31);
    const auto high = static_cast<std::int64_t>(x1 * y1 + (middle >> 31) + (low >> 62));
    const auto rest = static_cast<std::int64_t>(low & ((std::uint64_t{1} << 62) - 1));
    return negative ? std::pair{-high, -rest} : std::pair{high, rest};
  };
  const auto left = split_product(a, b), right = split_product(c, d);
  return left.first != right.first ? sign(left.first - right.first)
                                   : sign(left.second - right.second);
}

TEST(ExactPredicates, orientation_is_that_of_integers) {
  Random random(1);
  int on_one_line = 0;
  for (int i = 0; i < 200000; ++i) {
    std::int64_t x[3], y[3];
    for (int k = 0; k < 2; ++k) {
      x[k] = static_cast<std::int64_t>(random.uniform(0, 0x1p53));
      y[k] = static_cast<std::int64_t>(random.uniform(0, 0x1p53));
    }
    const double t = 0.25 * random.index(5);
    x[2] = x[0] + static_cast<std::int64_t>(t * static_cast<double>(x[1] - x[0])) + random.index(2);
    y[2] = y[0] + static_cast<std::int64_t>(t * static_cast<double>(y[1] - y[0])) + random.index(2);
    const auto point = [&](int k) {
      return Vec2d(std::ldexp(static_cast<double>(x[k]), -53),
                   std::ldexp(static_cast<double>(y[k]), -53));
    };
    if (std::max(x[2], y[2]) > (std::int64_t{1} << 53)) continue;
    const int expected = compare_products(x[0] - x[2], y[1] - y[2], y[0] - y[2], x[1] - x[2]);
    on_one_line += expected == 0;
    ASSERT_EQ(orientation(point(0), point(1), point(2)), expected);
    ASSERT_EQ(orientation(point(1), point(2), point(0)), expected);
    ASSERT_EQ(orientation(point(2), point(1), point(0)), -expected);
    ASSERT_EQ(area_sign(std::vector<Vec2d>{point(0), point(1), point(2)}), expected);
  }
  EXPECT_GT(on_one_line, 1000);
}

TEST(ExactPredicates, in_circle_is_that_of_integers_wherever_the_origin_is) {
  Random random(2);
  int on_circle = 0;
  for (int i = 0; i < 100000; ++i) {
    const std::uint32_t side = 3 + random.index(i % 2 == 0 ? 5 : 4000);
    std::int64_t x[4], y[4];
    for (int k = 0; k < 4; ++k) x[k] = random.index(side), y[k] = random.index(side);
    const auto cross = [&](int a, int b) {
      return (x[a] - x[3]) * (y[b] - y[3]) - (y[a] - y[3]) * (x[b] - x[3]);
    };
    const auto norm = [&](int a) {
      return (x[a] - x[3]) * (x[a] - x[3]) + (y[a] - y[3]) * (y[a] - y[3]);
    };
    const int expected =
        sign(norm(0) * cross(1, 2) + norm(1) * cross(2, 0) + norm(2) * cross(0, 1));
    on_circle += expected == 0;
    const double scale = std::ldexp(1.0, static_cast<int>(random.index(80)) - 40),
                 offset = random.index(2) * 1e6;
    const auto point = [&](int k) {
      return Vec2d(scale * (static_cast<double>(x[k]) + offset),
                   scale * (static_cast<double>(y[k]) - offset));
    };
    ASSERT_EQ(in_circle(point(0), point(1), point(2), point(3)), expected);
  }
  EXPECT_GT(on_circle, 1000);
}

TEST(ExactPredicates, in_circle_changes_sign_when_two_points_change_places) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    Vec2d p[4];
    const double offset = random.index(3) * 1e3;
    for (Vec2d& q :
         p) {  // on a circle within rounding, with coordinates whose differences are not exact
      const Vec3d direction = random.direction();
      q = Vec2d(direction.x(), direction.y()) / std::hypot(direction.x(), direction.y());
      q *= random.index(4) == 0 ? 1e-9 : 1.0;
      q.x() += offset;
    }
    const int value = in_circle(p[0], p[1], p[2], p[3]);
    ASSERT_EQ(in_circle(p[1], p[2], p[0], p[3]), value);
    ASSERT_EQ(in_circle(p[1], p[0], p[2], p[3]), -value);
    ASSERT_EQ(in_circle(p[3], p[1], p[2], p[0]), -value);
    ASSERT_EQ(in_circle(p[0], p[3], p[2], p[1]), -value);
  }
}

TEST(ExactPredicates, range_ends_where_products_overflow) {
  EXPECT_FALSE(exact_range({std::nan(""), 0}));
  EXPECT_FALSE(exact_range({0, -HUGE_VAL}));
  EXPECT_FALSE(exact_range({1e61, 0}));
  EXPECT_EQ(exact_range({1e60, -1e-61}), Vec2d(1e60, 0));
  EXPECT_EQ(in_circle({1e-60, 0}, {0, 1e-60}, {-1e-60, 0}, {0, -1e-60}), 0);
  EXPECT_EQ(in_circle({1e60, 0}, {0, 1e60}, {-1e60, 0}, {0, -1e60}), 0);
}

}  // namespace
}  // namespace sunder::tear
