#include "core/internal/all_finite.h"

#include <sunder/core/math.h>

#include <limits>

#include <gtest/gtest.h>

namespace sunder {
namespace {

TEST(AllFinite, one_number_that_is_not_is_found_at_any_place) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity(),
                  kLargest = std::numeric_limits<float>::max();
  for (std::size_t count = 0; count < 40; ++count) {
    std::vector<float> numbers(count, -kLargest);
    EXPECT_TRUE(all_finite(numbers)) << count;
    for (std::size_t at = 0; at < count; ++at)
      for (const float bad : {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
        std::vector<float> spoilt = numbers;
        spoilt[at] = bad;
        EXPECT_FALSE(all_finite(spoilt)) << at << " of " << count;
      }
  }
}

TEST(AllFinite, vectors_are_their_coordinates) {
  std::vector<Vec3f> vectors(7, Vec3f(1, -2, 0));
  EXPECT_TRUE(all_finite(vectors));
  vectors[6].z() = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(all_finite(vectors));
  EXPECT_TRUE(all_finite(std::vector<Vec3f>()));
}

}  // namespace
}  // namespace sunder
