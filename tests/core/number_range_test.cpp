#include "core/internal/number_range.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace sunder {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity(),
                 kNotANumber = std::numeric_limits<double>::quiet_NaN();

TEST(NumberRange, names_the_field_the_value_and_the_range) {
  const NumberRange range = {.field = "depth", .least = 0, .most = 5, .unit = " m"};
  EXPECT_EQ(range.check(-1).text(), "depth is -1 m; it must be from 0 to 5 m");
  EXPECT_EQ(range.check(-1).code(), StatusCode::invalid_argument);
  const NumberRange open = {
      .field = "bound", .least = 1, .most = 1e9, .is_above_least = true, .or_else = "0"};
  EXPECT_EQ(open.check(1).text(), "bound is 1; it must be above 1 and at most 1e+09, or 0");
}

TEST(NumberRange, holds_its_ends_and_nothing_that_is_not_finite) {
  const NumberRange range = {.field = "x", .least = -2, .most = 3};
  for (const double inside : {-2.0, 0.0, 3.0}) EXPECT_TRUE(range.check(inside)) << inside;
  for (const double outside : {-2.0001, 3.0001, 1e300, -1e300})
    EXPECT_EQ(range.check(outside).code(), StatusCode::invalid_argument) << outside;
  for (const double odd : {kNotANumber, kInfinity, -kInfinity})
    EXPECT_EQ(range.check(odd).code(), StatusCode::non_finite_value) << odd;
  const NumberRange open = {.field = "x", .least = -2, .most = 3, .is_above_least = true};
  EXPECT_FALSE(open.check(-2));
  EXPECT_TRUE(open.check(std::nextafter(-2.0, 0.0)));
}

TEST(NumberRange, of_degrees_forgives_the_way_through_radians) {
  const NumberRange range = {.field = "tilt", .least = -80, .most = 80, .unit = " degrees"};
  for (const double degrees : {80.0, -80.0, 0.1}) {
    const double radians = degrees * std::numbers::pi / 180;
    EXPECT_TRUE(range.check_degrees(radians)) << degrees;
    EXPECT_TRUE(range.check_degrees(static_cast<float>(radians))) << degrees;
  }
  EXPECT_EQ(range.check_degrees(81 * std::numbers::pi / 180).text(),
            "tilt is 81 degrees; it must be from -80 to 80 degrees");
  EXPECT_FALSE(range.check_degrees(kNotANumber));
}

}  // namespace
}  // namespace sunder
