#include "weights/internal/point_refit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/machine/stress.h"
#include "support/models/refit_scene.h"
#include "support/oracles/simplex_oracle.h"

namespace sunder {
namespace {

void expect_storable(std::span<const Influence> influences, std::size_t maximum) {
  ASSERT_FALSE(influences.empty());
  if (maximum > 0) {
    EXPECT_LE(influences.size(), maximum);
  }
  double sum = 0;
  std::set<std::uint32_t> slots;
  for (std::size_t i = 0; i < influences.size(); ++i) {
    EXPECT_GT(influences[i].weight, 0);
    if (i > 0) {
      EXPECT_LE(influences[i].weight, influences[i - 1].weight);
    }
    EXPECT_TRUE(slots.insert(influences[i].slot).second);
    sum += static_cast<double>(influences[i].weight);
  }
  EXPECT_NEAR(sum, 1, 2e-7 * static_cast<double>(influences.size()));
}

/// The error of each bone alone at a bind position, in all poses: one column per term of the point.
Eigen::MatrixXd off_by_bone(const test::Lip& lip, std::size_t point, const Vec3d& position) {
  const auto terms = lip.exact[point].terms();
  Eigen::MatrixXd off(3 * lip.palettes.size(), terms.size());
  for (std::size_t pose = 0; pose < lip.palettes.size(); ++pose) {
    const Vec3d target = lip.target(point, pose);
    for (std::size_t i = 0; i < terms.size(); ++i)
      off.block<3, 1>(static_cast<Eigen::Index>(3 * pose), static_cast<Eigen::Index>(i)) =
          lip.palettes[pose][terms[i].slot] * position - target;
  }
  return off / std::sqrt(static_cast<double>(lip.palettes.size()));
}

/// The exact optimum of the weights at a bind position, with at most `maximum` of them.
test::SimplexOptimum best_weights(const test::Lip& lip, std::size_t point, const Vec3d& position,
                                  std::size_t maximum) {
  const Eigen::MatrixXd off = off_by_bone(lip, point, position);
  return test::best_on_simplex(off.transpose() * off, Eigen::VectorXd::Zero(off.cols()), maximum);
}

/// The exact optimum of the bind position for weights.
Vec3d best_position(const test::Lip& lip, std::size_t point, const Eigen::VectorXd& weights) {
  const auto terms = lip.exact[point].terms();
  Eigen::MatrixXd linear(3 * lip.palettes.size(), 3);
  Eigen::VectorXd right(3 * lip.palettes.size());
  for (std::size_t pose = 0; pose < lip.palettes.size(); ++pose) {
    Affine3d blended = Affine3d::Identity();
    blended.matrix().setZero();
    for (std::size_t i = 0; i < terms.size(); ++i)
      blended.matrix() +=
          weights[static_cast<Eigen::Index>(i)] * lip.palettes[pose][terms[i].slot].matrix();
    linear.middleRows<3>(static_cast<Eigen::Index>(3 * pose)) = blended.linear();
    right.segment<3>(static_cast<Eigen::Index>(3 * pose)) =
        lip.target(point, pose) - blended.translation();
  }
  return linear.colPivHouseholderQr().solve(right);
}

/// The least mean square of alternating exact solves, from many starts, over all subsets of bones.
double best_of_all_turns(const test::Lip& lip, std::size_t point, std::size_t maximum,
                         test::Random& random) {
  double best = std::numeric_limits<double>::infinity();
  for (int start = 0; start < 20; ++start) {
    Vec3d position = lip.points[point].position;
    if (start > 0) position += 0.05 * random.direction();
    double before = std::numeric_limits<double>::infinity();
    for (int turn = 0; turn < 60; ++turn) {
      const test::SimplexOptimum optimum = best_weights(lip, point, position, maximum);
      best = std::min(best, optimum.value);
      if (!(optimum.value < (1 - 1e-5) * before)) break;
      before = optimum.value;
      position = best_position(lip, point, optimum.weights);
    }
  }
  return best;
}

TEST(PointRefit, is_never_worse_than_barycentric_as_it_is_stored) {
  test::Random random(1);
  PointRefit refit;
  for (const Vec3d& centre : {Vec3d(0, 0, 0), Vec3d(3e5, -1e6, 2e5)})
    for (const std::size_t maximum : {0u, 1u, 4u})
      for (const bool moves_bind : {false, true}) {
        const test::Lip lip(random,
                            {.points = 60, .maximum_influences = maximum, .centre = centre});
        std::size_t better = 0;
        for (std::size_t i = 0; i < lip.points.size(); ++i) {
          const auto fit = refit.fit(lip.points[i], {maximum, moves_bind}, lip.moments[0]);
          expect_storable(fit.influences, maximum);
          if (!moves_bind) {
            EXPECT_EQ(fit.position, lip.points[i].position);
          }
          const double before = lip.mean_square(i, lip.barycentric[i], lip.points[i].position);
          const double after = lip.mean_square(i, fit.influences, fit.position);
          // A thousand kilometres away a double holds 1e-10 m.
          EXPECT_LE(std::sqrt(after), std::sqrt(before) + 1e-8);
          EXPECT_NEAR(std::sqrt(fit.mean_square), std::sqrt(after), 1e-8);
          EXPECT_NEAR(std::sqrt(fit.barycentric_mean_square), std::sqrt(before), 1e-8);
          if (fit.is_better) {
            EXPECT_LT(fit.mean_square, fit.barycentric_mean_square);
          }
          if (!fit.is_better) {
            EXPECT_TRUE(std::ranges::equal(fit.influences, lip.barycentric[i]));
          }
          better += fit.is_better ? 1 : 0;
        }
        EXPECT_GT(better, maximum == 1 && !moves_bind ? 0u : lip.points.size() / 2);
      }
}

TEST(PointRefit, where_all_bones_move_alike_there_is_no_error) {
  test::Random random(2);
  PointRefit refit;
  test::Lip lip(random, {.points = 40, .maximum_influences = 0});
  PoseMoments alike(8, Vec3d::Zero());
  for (const AnimationPoint& exact : lip.exact) alike.want(exact);
  for (int pose = 0; pose < 6; ++pose)
    alike.add(std::vector<Affine3d>(8, test::bent_chain(random, 1, 2.0, Vec3d(0.1, 0.2, 0.3))[0]));
  for (const PointToRefit& point : lip.points)
    for (const std::size_t maximum : {0u, 4u}) {
      const auto fit = refit.fit(point, {maximum, true}, alike);
      EXPECT_LT(std::sqrt(fit.mean_square), 1e-7);
      EXPECT_LT((fit.position - point.position).norm(), 1e-6);
    }
}

TEST(PointRefit, weights_alone_are_the_exact_optimum) {
  test::Random random(3);
  PointRefit refit;
  int checked = 0;
  for (int i = 0; i < test::stressed(10, 10); ++i) {
    const test::Lip lip(random, {.points = 20, .slots = 12, .maximum_influences = 0, .angle = 0.9});
    for (std::size_t point = 0; point < lip.points.size(); ++point) {
      const std::size_t count = lip.exact[point].terms().size();
      if (count > 7) continue;
      const auto fit = refit.fit(lip.points[point], {0, false}, lip.moments[0]);
      const double best =
          std::sqrt(best_weights(lip, point, lip.points[point].position, count).value);
      EXPECT_NEAR(std::sqrt(fit.mean_square), best, 1e-6 * best + 1e-7);
      ++checked;
    }
  }
  EXPECT_GT(checked, 100);
}

TEST(PointRefit, nearly_all_points_are_within_two_percent_of_an_exhaustive_search) {
  test::Random random(4);
  PointRefit refit;
  for (const bool moves_bind : {false, true}) {
    double worst = 1, sum = 0, best_sum = 0;
    int checked = 0, over = 0;
    for (int i = 0; i < test::stressed(25, 10); ++i) {
      const test::Lip lip(random, {.points = 20, .slots = 14, .angle = 0.9, .face = 0.25});
      for (std::size_t point = 0; point < lip.points.size(); ++point) {
        const std::size_t count = lip.exact[point].terms().size();
        if (count < 5 || count > 7) continue;
        const auto fit = refit.fit(lip.points[point], {4, moves_bind}, lip.moments[0]);
        const double best = moves_bind
                                ? best_of_all_turns(lip, point, 4, random)
                                : best_weights(lip, point, lip.points[point].position, 4).value;
        worst = std::max(worst, std::sqrt(fit.mean_square / best));
        sum += std::sqrt(fit.mean_square);
        best_sum += std::sqrt(best);
        ++checked;
        over += std::sqrt(fit.mean_square / best) > 1.02 ? 1 : 0;
      }
    }
    EXPECT_GT(checked, 100);
    EXPECT_LE(50 * over, checked) << "worst " << worst;
    EXPECT_LE(sum, 1.002 * best_sum);
  }
}

TEST(PointRefit, allocates_nothing_once_warm) {
  test::Random random(5);
  PointRefit refit;
  const test::Lip lip(random, {.points = 40});
  const auto fit_all = [&] {
    double sum = 0;
    for (const PointToRefit& point : lip.points)
      sum += refit.fit(point, {4, true}, lip.moments[0]).mean_square;
    return sum;
  };
  const double first = fit_all();
  const std::uint64_t before = test::allocation_count();
  const double second = fit_all();
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_EQ(first, second) << "the same bits";
}

TEST(PointRefit, one_bone_is_kept) {
  test::Random random(6);
  PointRefit refit;
  const test::Lip lip(random, {.points = 10, .slots = 1});
  for (const PointToRefit& point : lip.points) {
    const auto fit = refit.fit(point, {4, true}, lip.moments[0]);
    ASSERT_EQ(fit.influences.size(), 1u);
    EXPECT_EQ(fit.influences[0], (Influence{0, 1.0f}));
    EXPECT_LT((fit.position - point.position).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace sunder
