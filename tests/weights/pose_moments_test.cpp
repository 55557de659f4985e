#include "weights/internal/pose_moments.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/models/random_skin.h"

namespace sunder {
namespace {

constexpr std::uint32_t kMomentSlots = 12;

/// The difference of two points: some slots in any order; last components that add up to zero.
std::vector<AnimationPoint::Term> random_difference(test::Random& random) {
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < kMomentSlots; ++slot) slots.push_back(slot);
  std::vector<AnimationPoint::Term> difference;
  const std::uint32_t count = 2 + random.index(6);
  double sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::swap(slots[i], slots[i + random.index(kMomentSlots - i)]);
    const double weight = i + 1 < count ? random.uniform(-1, 1) : -sum;
    sum += weight;
    const Vec3d place = random.direction();
    difference.push_back({slots[i], {place.x(), place.y(), place.z(), weight}});
  }
  return difference;
}

/// A point moved by the same bones.
AnimationPoint point_of(const std::vector<AnimationPoint::Term>& terms) {
  AnimationPoint point;
  for (const auto& term : terms) {
    const Influence influence{term.slot, 1.0f};
    point.add(1, Vec3d::Zero(), {&influence, 1});
  }
  return point;
}

double direct_mean_square(const std::vector<AnimationPoint::Term>& difference,
                          const std::vector<std::vector<Affine3d>>& palettes) {
  double sum = 0;
  for (const auto& palette : palettes) {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (const auto& term : difference)
      place += palette[term.slot].linear() * term.q.head<3>() +
               term.q.w() * palette[term.slot].translation();
    sum += place.squaredNorm();
  }
  return sum / static_cast<double>(palettes.size());
}

TEST(PoseMoments, mean_square_is_the_mean_over_the_poses) {
  test::Random random(1);
  for (int i = 0; i < 200; ++i) {
    const auto difference = random_difference(random);
    PoseMoments moments(kMomentSlots, Vec3d::Zero());
    moments.want(point_of(random_difference(random)));
    moments.want(point_of(difference));
    moments.want(point_of(random_difference(random)));
    std::vector<std::vector<Affine3d>> palettes;
    const std::uint32_t poses = 1 + random.index(9);
    for (std::uint32_t pose = 0; pose < poses; ++pose) {
      palettes.push_back(test::random_palette(random, kMomentSlots, 2));
      moments.add(palettes.back());
    }
    EXPECT_EQ(moments.pose_count(), palettes.size());
    const double direct = direct_mean_square(difference, palettes);
    EXPECT_NEAR(moments.mean_square(difference), direct, 1e-12 * (1 + direct));
  }
}

TEST(PoseMoments, nothing_is_lost_a_thousand_kilometres_from_the_origin) {
  test::Random random(2);
  const Vec3d centre(1e6, -3e5, 2e5);
  for (int i = 0; i < 100; ++i) {
    const auto difference = random_difference(random);
    PoseMoments moments(kMomentSlots, centre);
    moments.want(point_of(difference));
    std::vector<std::vector<Affine3d>> palettes;
    for (int pose = 0; pose < 5; ++pose) {
      palettes.push_back(test::random_palette(random, kMomentSlots));
      std::vector<Affine3d> there = palettes.back();
      for (Affine3d& matrix : there)
        matrix = Eigen::Translation3d(centre) * matrix * Eigen::Translation3d(-centre);
      moments.add(there);
    }
    // The translations of the caller are only accurate to 1e-10.
    const double direct = direct_mean_square(difference, palettes);
    EXPECT_NEAR(std::sqrt(moments.mean_square(difference)), std::sqrt(direct), 1e-8);
  }
}

TEST(PoseMoments, a_pair_is_held_once) {
  test::Random random(3);
  const auto difference = random_difference(random);
  const std::size_t n = difference.size();
  PoseMoments moments(kMomentSlots, Vec3d::Zero());
  moments.want(point_of(difference));
  moments.want(point_of({difference.rbegin(), difference.rend()}));
  EXPECT_EQ(moments.pair_count(), n * (n + 1) / 2);
}

TEST(PoseMoments, without_poses_there_is_no_distance) {
  test::Random random(4);
  const auto difference = random_difference(random);
  PoseMoments moments(kMomentSlots, Vec3d::Zero());
  moments.want(point_of(difference));
  EXPECT_EQ(moments.mean_square(difference), 0);
}

}  // namespace
}  // namespace sunder
