#include "core/internal/elementary.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The distance of a number from the exact one, in units of its last place.
double error_in_last_places(double found, long double exact) {
  int power = 0;
  std::frexp(std::max(std::abs(found), std::abs(static_cast<double>(exact))), &power);
  const long double place = std::ldexp(1.0L, std::max(power - DBL_MANT_DIG, -1074));
  return static_cast<double>(std::abs(static_cast<long double>(found) - exact) / place);
}

struct Function {
  const char* name;
  double (*ours)(double);
  long double (*exact)(long double);
  double least, most;
};

std::vector<Function> functions() {
  return {{"sin", elementary::sin, std::sin, -1e6, 1e6},
          {"sin", elementary::sin, std::sin, -4, 4},
          {"cos", elementary::cos, std::cos, -1e6, 1e6},
          {"cos", elementary::cos, std::cos, -4, 4},
          {"asin", elementary::asin, std::asin, -1, 1},
          {"acos", elementary::acos, std::acos, -1, 1},
          {"exp", elementary::exp, std::exp, -745, 709},
          {"exp", elementary::exp, std::exp, -1, 1},
          {"expm1", elementary::expm1, std::expm1, -2, 2},
          {"expm1", elementary::expm1, std::expm1, -50, 700},
          {"log", elementary::log, std::log, 0, 4},
          {"log", elementary::log, std::log, 0, 1e290}};
}

class Elementary : public testing::Test {
 protected:
  void SetUp() override {
    if (LDBL_MANT_DIG <= DBL_MANT_DIG)
      GTEST_SKIP() << "long double has no more digits than double here";
  }
};

TEST_F(Elementary, results_are_within_four_units_of_the_last_place) {
  for (const Function& function : functions()) {
    Random random(1);
    double worst = 0, at = 0;
    for (int i = 0; i < 40000; ++i) {
      double x = random.uniform(function.least, function.most);
      if (i % 2 == 0) x *= std::exp2(-random.uniform(0, 80));  // near zero too
      if (i % 5 == 0 && function.most == 1) x = std::copysign(1 - std::abs(x), x);
      const double error =
          error_in_last_places(function.ours(x), function.exact(static_cast<long double>(x)));
      if (!(error <= worst)) worst = error, at = x;
    }
    EXPECT_LE(worst, 4) << function.name << " at " << at;
  }
}

TEST_F(Elementary, arc_tangents_of_points_in_every_direction) {
  Random random(2);
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const double angle = random.uniform(0, 7), size = std::exp2(random.uniform(-300, 300));
    const double flat = i % 3 == 0 ? std::exp2(-random.uniform(0, 60)) : 1;
    double y = size * std::sin(angle) * flat, x = size * std::cos(angle);
    if (i % 2 == 0) std::swap(x, y);
    worst = std::max(worst, error_in_last_places(elementary::atan2(y, x),
                                                 std::atan2(static_cast<long double>(y),
                                                            static_cast<long double>(x))));
  }
  EXPECT_LE(worst, 4);
}

TEST_F(Elementary, large_angles_lose_no_more_than_is_said) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const double x = std::exp2(random.uniform(20, 45));
    const double most = std::ldexp(x, -53) + 1e-15;
    EXPECT_LE(std::abs(static_cast<long double>(elementary::sin(x)) -
                       std::sin(static_cast<long double>(x))),
              most);
    EXPECT_LE(std::abs(static_cast<long double>(elementary::cos(x)) -
                       std::cos(static_cast<long double>(x))),
              most);
  }
}

/// Equal numbers with equal signs, or both no number.
testing::AssertionResult same(double found, double wanted) {
  if ((std::isnan(found) && std::isnan(wanted)) ||
      (found == wanted && std::signbit(found) == std::signbit(wanted)))
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << found << " is not " << wanted;
}

TEST(ElementaryLimits, are_those_of_the_c_library) {
  for (const double x : {0.0, -0.0, kInfinity, -kInfinity, kNaN}) {
    EXPECT_TRUE(same(elementary::sin(x), std::sin(x)));
    EXPECT_TRUE(same(elementary::cos(x), std::cos(x)));
    EXPECT_TRUE(same(elementary::asin(x), std::asin(x)));
    EXPECT_TRUE(same(elementary::exp(x), std::exp(x)));
    EXPECT_TRUE(same(elementary::expm1(x), std::expm1(x)));
    EXPECT_TRUE(same(elementary::log(x), std::log(x)));
    for (const double y : {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, kNaN}) {
      EXPECT_TRUE(same(elementary::atan2(y, x), std::atan2(y, x))) << y << " " << x;
      EXPECT_TRUE(same(elementary::atan2(x, y), std::atan2(x, y))) << x << " " << y;
    }
  }
  for (const double x : {1.0, -1.0, 1.5, -1.5}) {
    EXPECT_TRUE(same(elementary::asin(x), std::asin(x))) << x;
    EXPECT_TRUE(same(elementary::acos(x), std::acos(x))) << x;
  }
  EXPECT_TRUE(same(elementary::log(1), 0.0));
  EXPECT_TRUE(same(elementary::log(-1), kNaN));
  EXPECT_TRUE(same(elementary::exp(1000), kInfinity));
  EXPECT_TRUE(same(elementary::exp(-1000), 0.0));
  EXPECT_TRUE(same(elementary::exp(-745), std::exp(-745.0)));
  EXPECT_TRUE(same(elementary::log(4.9e-324), std::log(4.9e-324)));
}

}  // namespace
}  // namespace sunder::test
