// Fits that may exceed no bound over any group of poses.

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/machine/stress.h"
#include "support/models/refit_scene.h"
#include "support/oracles/coupled.h"
#include "weights/internal/coupled_refit.h"
#include "weights/internal/point_refit.h"

namespace sunder {
namespace {

/// A lip whose poses are in groups of unequal wildness, and last the sum to minimise: each group
/// relative to what barycentric weights have there.
struct Groups {
  static constexpr std::size_t kCount = 4;

  explicit Groups(test::Random& random, const test::RefitScene& scene = {})
      : lip(random, scene), moments(scene.slots, scene.centre, kCount + 1) {
    for (const AnimationPoint& exact : lip.exact) moments.want(exact);
    for (std::size_t group = 0; group < kCount; ++group)
      for (int i = 0; i < 6; ++i) {
        const double angle = std::pow(0.2, static_cast<double>(group));
        palettes[group].push_back(test::bent_chain(random, scene.slots, angle, scene.centre));
        moments.add(palettes[group].back(), group);
      }
    std::vector<double> factors(kCount + 1, 0.0);
    for (std::size_t point = 0; point < lip.points.size(); ++point)
      for (std::size_t group = 0; group < kCount; ++group) {
        bounds.push_back((1 + 1e-9) * mean_square(point, group, lip.barycentric[point],
                                                  lip.points[point].position));
        factors[group] += bounds.back();
      }
    for (double& factor : factors) factor = factor > 0 ? 1 / factor : 0.0;
    moments.combine(factors, kCount);
  }

  /// Pose by pose, from the matrices alone.
  [[nodiscard]] double mean_square(std::size_t point, std::size_t group,
                                   std::span<const Influence> influences,
                                   const Vec3d& position) const {
    double sum = 0, weight_sum = 0, exact_sum = 0;
    for (const Influence& of : influences) weight_sum += static_cast<double>(of.weight);
    for (const auto& term : lip.exact[point].terms()) exact_sum += term.q.w();
    for (const auto& palette : palettes[group]) {
      const Vec3d wanted = lip.exact[point].posed(palette) / exact_sum;
      Eigen::Vector3d difference = Eigen::Vector3d::Zero();
      for (const Influence& of : influences)
        difference +=
            static_cast<double>(of.weight) / weight_sum * (palette[of.slot] * position - wanted);
      sum += difference.squaredNorm();
    }
    return sum / static_cast<double>(palettes[group].size());
  }

  [[nodiscard]] PointToRefit point(std::size_t i) const {
    PointToRefit point = lip.points[i];
    point.allowed = std::span(bounds).subspan(i * kCount, kCount);
    return point;
  }
  /// The sum that is minimised.
  [[nodiscard]] double objective(std::size_t point, std::span<const Influence> influences,
                                 const Vec3d& position) const {
    double sum = 0;
    for (std::size_t group = 0; group < kCount; ++group) {
      double all = 0;
      for (std::size_t i = 0; i < lip.points.size(); ++i) all += bounds[i * kCount + group];
      sum += mean_square(point, group, influences, position) / all;
    }
    return sum;
  }

  test::Lip lip;
  PoseMoments moments;
  std::vector<std::vector<Affine3d>> palettes[kCount];
  std::vector<double> bounds;
};

TEST(BoundedRefit, no_group_of_poses_is_worse_than_with_barycentric_weights) {
  test::Random random(1);
  PointRefit refit;
  int better = 0, fits = 0;
  for (int scene = 0; scene < test::stressed(20, 20); ++scene) {
    const Groups groups(random, {.points = 20, .slots = 10});
    for (const bool moves_bind : {false, true})
      for (std::size_t i = 0; i < groups.lip.points.size(); ++i) {
        const auto fit =
            refit.fit(groups.point(i), {4, moves_bind, Groups::kCount}, groups.moments);
        for (std::size_t group = 0; group < Groups::kCount; ++group) {
          const double bound = groups.bounds[i * Groups::kCount + group];
          ASSERT_LE(std::sqrt(groups.mean_square(i, group, fit.influences, fit.position)),
                    std::sqrt(bound) * (1 + 1e-6) + 1e-9);
        }
        ASSERT_LE(fit.influences.size(), 4u);
        better += fit.is_better ? 1 : 0;
        ++fits;
        if (!fit.is_better) {
          EXPECT_EQ(fit.position, groups.lip.points[i].position);
          EXPECT_TRUE(std::ranges::equal(fit.influences, groups.lip.barycentric[i]));
        }
      }
  }
  EXPECT_GT(better, fits / 2);
}

TEST(BoundedRefit, weights_of_three_bones_are_within_two_percent_of_all_weights_on_a_grid) {
  test::Random random(2);
  PointRefit refit;
  double of_fits = 0, of_grid = 0;
  int checked = 0;
  for (int scene = 0; scene < test::stressed(20, 10); ++scene) {
    const Groups groups(random, {.points = 20, .slots = 4, .maximum_influences = 0});
    for (std::size_t i = 0; i < groups.lip.points.size(); ++i) {
      if (groups.lip.exact[i].terms().size() != 3) continue;
      const Vec3d& position = groups.lip.points[i].position;
      const auto fit = refit.fit(groups.point(i), {0, false, Groups::kCount}, groups.moments);
      double best = groups.objective(i, groups.lip.barycentric[i], position);
      constexpr int kSteps = 120;
      for (int a = 0; a <= kSteps; ++a)
        for (int b = 0; a + b <= kSteps; ++b) {
          const Influence influences[] = {
              {groups.lip.exact[i].terms()[0].slot, static_cast<float>(a) / kSteps},
              {groups.lip.exact[i].terms()[1].slot, static_cast<float>(b) / kSteps},
              {groups.lip.exact[i].terms()[2].slot, static_cast<float>(kSteps - a - b) / kSteps}};
          bool is_allowed = true;
          for (std::size_t group = 0; group < Groups::kCount && is_allowed; ++group)
            is_allowed = groups.mean_square(i, group, influences, position) <=
                         groups.bounds[i * Groups::kCount + group];
          if (is_allowed) best = std::min(best, groups.objective(i, influences, position));
        }
      of_fits += groups.objective(i, fit.influences, fit.position);
      of_grid += best;
      ++checked;
    }
  }
  EXPECT_GT(checked, 30);
  EXPECT_LE(std::sqrt(of_fits / of_grid), 1.02);
}

TEST(BoundedRefit, coupled_fits_exceed_no_bound_either_and_keep_most_of_the_gain) {
  if (!test::use_coupled_refit()) GTEST_SKIP() << "built without Ceres (SUNDER_CERES)";
  test::Random random(7);
  PointRefit refit;
  double of_start = 0, of_single = 0, of_coupled = 0;
  for (int scene = 0; scene < 10; ++scene) {
    const Groups groups(random, {.points = 20, .slots = 10});
    std::vector<PointToRefit> points;
    std::vector<RefitNeighbours> neighbours;
    for (std::uint32_t i = 0; i < groups.lip.points.size(); ++i) {
      points.push_back(groups.point(i));
      points.back().may_move = random.index(4) != 0;
      if (i > 0) neighbours.push_back({i - 1, i, 0.01});
    }
    const PointRefit::Options options{4, true, Groups::kCount};
    const auto fits = refit_coupled(points, neighbours, {options, 1e-6}, groups.moments);
    ASSERT_TRUE(fits) << fits.error().text();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const CoupledFit& fit = (*fits)[i];
      for (std::size_t group = 0; group < Groups::kCount; ++group) {
        const double bound = groups.bounds[i * Groups::kCount + group];
        ASSERT_LE(std::sqrt(groups.mean_square(i, group, fit.influences, fit.position)),
                  std::sqrt(bound) * (1 + 1e-6) + 1e-9);
      }
      if (!points[i].may_move) {
        EXPECT_EQ(fit.position, points[i].position);
      }
      of_start += fit.barycentric_mean_square;
      of_coupled += fit.mean_square;
      of_single += refit.fit(points[i], options, groups.moments).mean_square;
    }
  }
  EXPECT_LT(of_single, 0.9 * of_start);
  EXPECT_LT(of_start - of_single, 1.3 * (of_start - of_coupled));
}

TEST(BoundedRefit, own_poses_bind_too) {
  test::Random random(3);
  PointRefit refit;
  int bound = 0;
  for (int scene = 0; scene < 10; ++scene) {
    const Groups groups(random, {.points = 10, .slots = 10});
    for (std::size_t i = 0; i < groups.lip.points.size(); ++i) {
      const auto palette = test::bent_chain(random, 10, 1.0, Vec3d::Zero());
      PoseMoments own(10, groups.moments.centre());
      own.want(groups.lip.exact[i]);
      own.add(palette);
      const auto error = [&](std::span<const Influence> influences, const Vec3d& position) {
        double exact_sum = 0, sum = 0;
        for (const auto& term : groups.lip.exact[i].terms()) exact_sum += term.q.w();
        Eigen::Vector3d at = Eigen::Vector3d::Zero();
        for (const Influence& of : influences) sum += static_cast<double>(of.weight);
        for (const Influence& of : influences)
          at += static_cast<double>(of.weight) / sum * (palette[of.slot] * position);
        return (at - Eigen::Vector3d(groups.lip.exact[i].posed(palette) / exact_sum)).norm();
      };
      PointToRefit point = groups.point(i);
      const double before = error(groups.lip.barycentric[i], point.position);
      const auto free = refit.fit(point, {4, true, Groups::kCount}, groups.moments);
      bound += error(free.influences, free.position) > before ? 1 : 0;
      point.own_poses = &own;
      point.own_allowed = before * before * (1 + 1e-9);
      const auto fit = refit.fit(point, {4, true, Groups::kCount}, groups.moments);
      EXPECT_LE(error(fit.influences, fit.position), before * (1 + 1e-6) + 1e-9);
    }
  }
  EXPECT_GT(bound, 0) << "without the bound some would be worse";
}

TEST(BoundedRefit, a_point_that_may_not_move_stays_bit_for_bit) {
  test::Random random(4);
  PointRefit refit;
  const Groups groups(random, {.points = 40});
  for (std::size_t i = 0; i < groups.lip.points.size(); ++i) {
    PointToRefit point = groups.point(i);
    point.may_move = false;
    EXPECT_EQ(refit.fit(point, {4, true, Groups::kCount}, groups.moments).position, point.position);
  }
}

TEST(BoundedRefit, allocates_nothing_once_warm) {
  test::Random random(5);
  PointRefit refit;
  const Groups groups(random, {.points = 40, .slots = 10});
  const auto fit_all = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < groups.lip.points.size(); ++i)
      sum += refit.fit(groups.point(i), {4, true, Groups::kCount}, groups.moments).mean_square;
    return sum;
  };
  const double first = fit_all();
  const std::uint64_t before = test::allocation_count();
  EXPECT_EQ(fit_all(), first) << "the same bits";
  EXPECT_EQ(test::allocation_count(), before);
}

TEST(PoseMoments, groups_are_the_moments_of_their_own_poses_and_can_be_summed) {
  test::Random random(6);
  const Groups groups(random, {.points = 12, .slots = 6});
  for (const AnimationPoint& exact : groups.lip.exact) {
    std::vector<AnimationPoint::Term> difference(exact.terms().begin(), exact.terms().end());
    double sum = 0;
    for (auto& term : difference) {
      for (int k = 0; k < 4; ++k) term.q[k] = random.uniform(-1, 1);
      sum += term.q.w();
    }
    difference.back().q.w() -= sum;  // a difference of points
    double of_groups[Groups::kCount + 1];
    groups.moments.mean_squares(difference, of_groups);
    std::vector<double> factors;
    double combined = 0;
    for (std::size_t group = 0; group < Groups::kCount; ++group) {
      PoseMoments alone(6, groups.moments.centre());
      alone.want(exact);
      for (const auto& palette : groups.palettes[group]) alone.add(palette);
      const double wanted = alone.mean_square(difference);
      EXPECT_NEAR(of_groups[group], wanted, 1e-12 * (1 + wanted));
      EXPECT_NEAR(groups.moments.mean_square(difference, group), wanted, 1e-12 * (1 + wanted));
      double all = 0;
      for (std::size_t i = 0; i < groups.lip.points.size(); ++i)
        all += groups.bounds[i * Groups::kCount + group];
      combined += wanted / all;
    }
    EXPECT_NEAR(of_groups[Groups::kCount], combined, 1e-9 * (1 + combined));
  }
}

}  // namespace
}  // namespace sunder
