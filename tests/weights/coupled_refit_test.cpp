#include "weights/internal/coupled_refit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "support/models/refit_scene.h"
#include "support/oracles/coupled.h"

namespace sunder {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool same_bits(const std::vector<CoupledFit>& a, const std::vector<CoupledFit>& b) {
  return std::ranges::equal(a, b, [](const CoupledFit& x, const CoupledFit& y) {
    return x.influences == y.influences && x.position == y.position &&
           x.mean_square == y.mean_square &&
           x.barycentric_mean_square == y.barycentric_mean_square && x.is_better == y.is_better;
  });
}

/// Mean difference between the offsets of neighbours on the lip.
double mean_difference(const test::Lip& lip, const std::vector<CoupledFit>& fits) {
  double sum = 0;
  for (std::size_t i = 1; i < fits.size(); ++i)
    sum += ((fits[i].position - lip.points[i].position) -
            (fits[i - 1].position - lip.points[i - 1].position))
               .norm();
  return sum / static_cast<double>(fits.size() - 1);
}

/// The objective, computed independently: by poses, neighbours and slots.
double cost(const test::Lip& lip, const std::vector<CoupledFit>& fits, double smoothness) {
  double sum = 0;
  const auto change_of = [&](std::uint32_t point) {
    std::map<std::uint32_t, double> change;
    if (point == kNone) return change;
    for (const Influence& influence : fits[point].influences)
      change[influence.slot] += static_cast<double>(influence.weight);
    for (const Influence& influence : lip.barycentric[point])
      change[influence.slot] -= static_cast<double>(influence.weight);
    return change;
  };
  // Bones that only rotate have scale 1.
  for (std::uint32_t i = 0; i < fits.size(); ++i) {
    sum += lip.mean_square(i, fits[i].influences, fits[i].position);
    sum += 0.03 * (fits[i].position - lip.points[i].position).squaredNorm();
    double spread_square = 0, total = 0;
    for (const auto& term : lip.exact[i].terms()) {
      total += term.q.w();
      spread_square +=
          term.q.w() * (term.q.head<3>() / term.q.w() - lip.points[i].position).squaredNorm();
    }
    for (const auto& [slot, difference] : change_of(i))
      sum += 1e-3 * spread_square / total * difference * difference;
  }
  for (const RefitNeighbours& pair : lip.neighbours) {
    Vec3d moved = fits[pair.a].position - lip.points[pair.a].position;
    if (pair.b != kNone) moved -= fits[pair.b].position - lip.points[pair.b].position;
    std::map<std::uint32_t, double> change = change_of(pair.a);
    for (const auto& [slot, of_b] : change_of(pair.b)) change[slot] -= of_b;
    double change_square = 0;
    for (const auto& [slot, difference] : change) change_square += difference * difference;
    sum += smoothness * (moved.squaredNorm() + pair.length * pair.length * change_square);
  }
  return sum;
}

class CoupledRefit : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::use_coupled_refit()) GTEST_SKIP() << "built without Ceres (SUNDER_CERES)";
  }
};

TEST(CoupledRefitAbsent, is_an_error_that_names_the_library) {
  if (has_coupled_refit()) GTEST_SKIP() << "another test of this process turned it on";
  const auto fits = refit_coupled({}, {}, {}, PoseMoments(1, Vec3d::Zero()));
  ASSERT_FALSE(fits);
  EXPECT_EQ(fits.error().code(), StatusCode::unsupported_feature);
  EXPECT_NE(fits.error().text().find("sunder::coupled_refit"), std::string_view::npos);
}

TEST_F(CoupledRefit, is_never_worse_than_barycentric_as_it_is_stored) {
  test::Random random(1);
  for (const Vec3d& centre : {Vec3d(0, 0, 0), Vec3d(3e5, -1e6, 2e5)})
    for (const std::size_t maximum : {0u, 1u, 4u})
      for (const bool moves_bind : {false, true})
        for (const double smoothness : {0.0, 0.01, 10.0}) {
          const test::Lip lip(random,
                              {.points = 30, .maximum_influences = maximum, .centre = centre});
          const auto fits = refit_coupled(lip.points, lip.neighbours,
                                          {{maximum, moves_bind}, smoothness}, lip.moments[0]);
          ASSERT_TRUE(fits) << fits.error().text();
          ASSERT_EQ(fits->size(), lip.points.size());
          for (std::size_t i = 0; i < fits->size(); ++i) {
            const CoupledFit& fit = (*fits)[i];
            if (maximum > 0) {
              EXPECT_LE(fit.influences.size(), maximum);
            }
            double sum = 0;
            std::set<std::uint32_t> slots;
            for (const Influence& influence : fit.influences) {
              EXPECT_GT(influence.weight, 0);
              EXPECT_TRUE(slots.insert(influence.slot).second);
              sum += static_cast<double>(influence.weight);
            }
            EXPECT_NEAR(sum, 1, 2e-7 * static_cast<double>(fit.influences.size()));
            EXPECT_TRUE(
                std::ranges::is_sorted(fit.influences, std::ranges::greater(), &Influence::weight));
            if (!moves_bind) {
              EXPECT_EQ(fit.position, lip.points[i].position);
            }
            const double before = lip.mean_square(i, lip.barycentric[i], lip.points[i].position);
            const double after = lip.mean_square(i, fit.influences, fit.position);
            EXPECT_LE(std::sqrt(after), std::sqrt(before) + 1e-8);
            EXPECT_NEAR(std::sqrt(fit.mean_square), std::sqrt(after), 1e-8);
            EXPECT_NEAR(std::sqrt(fit.barycentric_mean_square), std::sqrt(before), 1e-8);
            if (fit.is_better) {
              EXPECT_LT(fit.mean_square, fit.barycentric_mean_square);
            }
            if (!fit.is_better) {
              EXPECT_EQ(fit.influences, lip.barycentric[i]);
            }
          }
        }
}

TEST_F(CoupledRefit, without_smoothness_is_not_worse_than_the_single_fits) {
  test::Random random(2);
  PointRefit refit;
  for (const bool moves_bind : {false, true}) {
    const test::Lip lip(random, {.points = 60, .slots = 14});
    const auto fits =
        refit_coupled(lip.points, lip.neighbours, {{4, moves_bind}, 0}, lip.moments[0]);
    ASSERT_TRUE(fits) << fits.error().text();
    for (std::size_t i = 0; i < fits->size(); ++i) {
      const double single = refit.fit(lip.points[i], {4, moves_bind}, lip.moments[0]).mean_square;
      // Both fits have a cost for moving the bind position, which is not part of the mean square.
      EXPECT_LE(std::sqrt((*fits)[i].mean_square), 1.001 * std::sqrt(single) + 1e-7);
    }
  }
}

TEST_F(CoupledRefit, smoothness_makes_neighbours_move_alike) {
  test::Random random(3);
  test::Lip lip(random, {.points = 60, .slots = 14, .maximum_influences = 0});
  std::erase_if(lip.neighbours, [](const RefitNeighbours& pair) { return pair.b == kNone; });
  double before = kInfinity, error_before = 0;
  for (const double smoothness : {0.0, 0.01, 0.1, 1.0}) {
    const auto fits =
        refit_coupled(lip.points, lip.neighbours, {{0, true}, smoothness}, lip.moments[0]);
    ASSERT_TRUE(fits) << fits.error().text();
    const double difference = mean_difference(lip, *fits);
    double error = 0;
    for (const CoupledFit& fit : *fits) error += fit.mean_square;
    EXPECT_LT(difference, before);
    EXPECT_GE(error, (1 - 1e-3) * error_before) << "which is what it costs";
    before = difference;
    error_before = error;
  }
}

TEST_F(CoupledRefit, nothing_near_the_result_costs_less) {
  test::Random random(10);
  // The moments of two poses are singular.
  for (const auto& [smoothness, poses] : {std::pair(0.01, 12u), {0.1, 12u}, {0.01, 2u}}) {
    const test::Lip lip(random,
                        {.points = 20, .slots = 14, .poses = poses, .maximum_influences = 0});
    const auto result =
        refit_coupled(lip.points, lip.neighbours, {{0, true}, smoothness}, lip.moments[0]);
    ASSERT_TRUE(result) << result.error().text();
    const double least = cost(lip, *result, smoothness);
    for (int i = 0; i < 500; ++i) {
      std::vector<CoupledFit> fits = *result;
      CoupledFit& fit = fits[random.index(20)];
      ASSERT_TRUE(fit.is_better) << "a point that was reset is not at the optimum";
      const double size = i % 2 == 0 ? 1e-4 : 1e-3;
      if (random.index(2) == 0) fit.position += size * random.direction();
      const float part =
          std::min(static_cast<float>(random.uniform(-size, size)), fit.influences.back().weight);
      fit.influences.front().weight += part;
      fit.influences.back().weight -= part;
      EXPECT_GE(cost(lip, fits, smoothness), (1 - 1e-6) * least);
    }
  }
}

TEST_F(CoupledRefit, old_neighbours_hold_a_point_where_it_was) {
  test::Random random(4);
  test::Lip lip(random, {.points = 30, .maximum_influences = 0});
  std::erase_if(lip.neighbours, [](const RefitNeighbours& pair) { return pair.b != kNone; });
  double before = kInfinity;
  for (const double smoothness : {0.0, 0.01, 0.1, 1.0}) {
    const auto fits =
        refit_coupled(lip.points, lip.neighbours, {{0, true}, smoothness}, lip.moments[0]);
    ASSERT_TRUE(fits) << fits.error().text();
    double moved = 0;
    for (std::size_t i = 0; i < fits->size(); ++i)
      moved += ((*fits)[i].position - lip.points[i].position).norm();
    EXPECT_LT(moved, before);
    before = moved;
  }
}

TEST_F(CoupledRefit, gives_the_same_bits_twice) {
  test::Random random(5);
  const test::Lip lip(random, {.points = 50});
  const auto first = refit_coupled(lip.points, lip.neighbours, {}, lip.moments[0]);
  const auto second = refit_coupled(lip.points, lip.neighbours, {}, lip.moments[0]);
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(same_bits(*first, *second));
}

TEST_F(CoupledRefit, points_that_cannot_be_fitted_stay_as_they_were) {
  test::Random random(6);
  test::Lip lip(random, {.points = 20});
  lip.points[7].position.x() = std::numeric_limits<double>::quiet_NaN();
  lip.points[11].position.x() = kInfinity;
  testing::internal::CaptureStderr();
  const auto fits = refit_coupled(lip.points, lip.neighbours, {}, lip.moments[0]);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_TRUE(fits) << fits.error().text();
  for (std::size_t i = 0; i < fits->size(); ++i) {
    if (i == 7 || i == 11) {
      EXPECT_EQ((*fits)[i].influences, lip.barycentric[i]);
      EXPECT_FALSE((*fits)[i].is_better);
    } else {
      EXPECT_TRUE((*fits)[i].position.allFinite());
    }
  }
}

TEST_F(CoupledRefit, few_points_and_few_bones_will_do) {
  test::Random random(7);
  for (const std::uint32_t slots : {1u, 2u})
    for (const std::uint32_t count : {0u, 1u, 2u}) {
      const test::Lip lip(random, {.points = count, .slots = slots, .poses = 1});
      testing::internal::CaptureStderr();
      const auto fits = refit_coupled(lip.points, lip.neighbours, {}, lip.moments[0]);
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
      ASSERT_TRUE(fits) << fits.error().text();
      EXPECT_EQ(fits->size(), count);
    }
}

TEST_F(CoupledRefit, prints_nothing) {
  test::Random random(8);
  const test::Lip lip(random, {.points = 50});
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  for (const double smoothness : {0.0, 0.01, 1e12})
    EXPECT_TRUE(refit_coupled(lip.points, lip.neighbours, {{}, smoothness}, lip.moments[0]));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(CoupledRefit, bad_input_is_an_error) {
  test::Random random(9);
  const test::Lip lip(random, {.points = 5});
  const auto error_of = [&](const std::vector<RefitNeighbours>& neighbours, double smoothness,
                            const PoseMoments& moments) {
    const auto fits = refit_coupled(lip.points, neighbours, {{}, smoothness}, moments);
    EXPECT_FALSE(fits);
    return std::pair(fits.error().code(), fits.error().index());
  };
  const RefitNeighbours good{0, 1, 0.1};
  const auto is = [](StatusCode code, std::uint32_t index) { return std::pair(code, index); };
  EXPECT_EQ(error_of({good, {5, 1, 0.1}}, 0.01, lip.moments[0]),
            is(StatusCode::index_out_of_range, 1));
  EXPECT_EQ(error_of({good, good, {1, 5, 0.1}}, 0.01, lip.moments[0]),
            is(StatusCode::index_out_of_range, 2));
  EXPECT_EQ(error_of({{kNone, 1, 0.1}}, 0.01, lip.moments[0]),
            is(StatusCode::index_out_of_range, 0));
  for (const double length : {-0.1, kInfinity, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(error_of({good, {1, kNone, length}}, 0.01, lip.moments[0]),
              is(StatusCode::invalid_argument, 1));
  for (const double smoothness : {-0.1, kInfinity, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(error_of({good}, smoothness, lip.moments[0]),
              is(StatusCode::invalid_argument, kNone));
  PoseMoments none(8, Vec3d::Zero());
  for (const AnimationPoint& exact : lip.exact) none.want(exact);
  EXPECT_EQ(error_of({good}, 0.01, none), is(StatusCode::empty_input, kNone));
}

}  // namespace
}  // namespace sunder
