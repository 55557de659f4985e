// Quantisation of <sunder/weights/influences.h>.

#include <sunder/weights/influences.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder {
namespace {

using QuantisedRow = std::vector<Influence>;

double sum_of(const QuantisedRow& influences) {
  double sum = 0;
  for (const Influence& influence : influences) sum += static_cast<double>(influence.weight);
  return sum;
}

/// Weights over several orders of magnitude, in any order, some of them equal; they add up to
/// `sum`, except for rounding.
QuantisedRow random_influences(test::Random& random, std::uint32_t count, double sum) {
  QuantisedRow influences;
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool is_alike = i > 0 && random.index(5) == 0;
    const double weight = std::pow(10, random.uniform(-4, 0));
    influences.push_back({i, is_alike ? influences.back().weight : static_cast<float>(weight)});
  }
  const double factor = sum / sum_of(influences);
  for (Influence& influence : influences)
    influence.weight = static_cast<float>(factor * static_cast<double>(influence.weight));
  return influences;
}

template <class Integer>
class Quantise : public testing::Test {
 protected:
  static constexpr std::uint32_t kUnits = std::numeric_limits<Integer>::max();

  static std::vector<Integer> quantised(const QuantisedRow& influences) {
    std::vector<Integer> result(influences.size());
    EXPECT_TRUE(quantise_weights(influences, std::span<Integer>(result)));
    return result;
  }

  static void expect_lawful(const QuantisedRow& influences) {
    const std::vector<Integer> result = quantised(influences);
    EXPECT_EQ(std::accumulate(result.begin(), result.end(), std::uint64_t{0}), kUnits);
    const double sum = sum_of(influences);
    double given = 0;  // units given to some weights and taken from others
    for (std::size_t i = 0; i < result.size(); ++i) {
      const double error =
          static_cast<double>(result[i]) - static_cast<double>(influences[i].weight) / sum * kUnits;
      EXPECT_LT(std::abs(error), 1) << i;
      given += std::max(error, 0.0);
      for (std::size_t j = 0; j < result.size() && result.size() <= 40; ++j)
        if (influences[i].weight > influences[j].weight) {
          EXPECT_GE(result[i], result[j]) << i << " is larger than " << j;
        }
    }
    EXPECT_LE(given, static_cast<double>(result.size()) / 4 + 1e-9);
  }
};

using Integers = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(Quantise, Integers);

TYPED_TEST(Quantise, sums_are_exact_errors_below_a_unit_and_the_order_stays) {
  test::Random random(21);
  for (std::uint32_t count = 1; count <= 40; ++count)
    for (int i = 0; i < 200; ++i) this->expect_lawful(random_influences(random, count, 1));
}

TYPED_TEST(Quantise, the_sum_need_not_be_one) {
  test::Random random(22);
  for (const double sum : {1.0 + 1e-5, 0.5, 255.0, 1e-44, 1e-38, 1e30})
    for (const std::uint32_t count : {1u, 2u, 4u, 7u}) {
      QuantisedRow influences = random_influences(random, count, sum);
      influences[0].weight =
          std::max(influences[0].weight, std::numeric_limits<float>::denorm_min());
      this->expect_lawful(influences);
    }
}

TYPED_TEST(Quantise, one_influence_has_all) {
  for (const float weight : {1.0f, 0.3f, 1.0f - 1e-7f, std::numeric_limits<float>::denorm_min(),
                             std::numeric_limits<float>::max()})
    EXPECT_EQ(this->quantised({{5, weight}})[0], this->kUnits);
}

TYPED_TEST(Quantise, equal_weights_give_to_the_first) {
  const std::vector<TypeParam> two = this->quantised({{8, 0.5f}, {2, 0.5f}});
  EXPECT_EQ(two[0], this->kUnits / 2 + 1);
  EXPECT_EQ(two[1], this->kUnits / 2);
}

TYPED_TEST(Quantise, equal_remainders_give_to_the_larger_weight) {
  // 0.5 and 1.5 units above whole ones, and the rest.
  const double units = this->kUnits;
  const std::vector<TypeParam> result =
      this->quantised({{0, 0.5f}, {1, 1.5f}, {2, static_cast<float>(units) - 2.0f}});
  EXPECT_EQ(result, (std::vector<TypeParam>{0, 2, static_cast<TypeParam>(units - 2)}));
}

TYPED_TEST(Quantise, tiny_weights_become_zero) {
  const float tiny = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(this->quantised({{0, tiny}, {1, 1.0f}, {2, 1e-9f}, {3, 0.0f}}),
            (std::vector<TypeParam>{0, static_cast<TypeParam>(this->kUnits), 0, 0}));
}

TYPED_TEST(Quantise, more_influences_than_units) {
  test::Random random(23);
  this->expect_lawful(random_influences(random, 4096, 1));
  const std::vector<TypeParam> equal = this->quantised(QuantisedRow(300, {0, 1.0f / 300}));
  EXPECT_EQ(std::accumulate(equal.begin(), equal.end(), std::uint64_t{0}), this->kUnits);
  EXPECT_TRUE(std::is_sorted(equal.rbegin(), equal.rend()));
  EXPECT_LE(equal.front() - equal.back(), 1);
}

TYPED_TEST(Quantise, invalid_weights_are_refused_and_nothing_is_written) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  const auto expect_refused = [](const QuantisedRow& influences, std::size_t size) {
    const std::vector<TypeParam> before(size, 77);
    std::vector<TypeParam> after = before;
    EXPECT_FALSE(quantise_weights(influences, std::span<TypeParam>(after)));
    EXPECT_EQ(after, before);
  };
  expect_refused({}, 0);
  expect_refused({{0, 0.0f}}, 1);
  expect_refused({{0, 0.0f}, {1, -0.0f}}, 2);
  expect_refused({{0, 0.5f}, {1, nan}}, 2);
  expect_refused({{0, 0.5f}, {1, infinity}}, 2);
  expect_refused({{0, 1.5f}, {1, -0.5f}}, 2);
  expect_refused({{0, 0.5f}, {1, 0.5f}}, 1);
  expect_refused({{0, 0.5f}, {1, 0.5f}}, 3);
  expect_refused({}, 2);
}

}  // namespace
}  // namespace sunder
