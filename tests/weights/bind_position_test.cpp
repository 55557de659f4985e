#include "weights/internal/bind_position.h"

#include <gtest/gtest.h>

#include "support/models/random_skin.h"

namespace sunder {
namespace {

Vec3d skinned(const Vec3d& bind, std::span<const Influence> influences,
              std::span<const Affine3d> palette) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Influence& influence : influences)
    sum += static_cast<double>(influence.weight) * (palette[influence.slot] * bind);
  return sum;
}

TEST(BindPosition, is_carried_to_the_place_wanted) {
  test::Random random(1);
  int solved = 0;
  for (int i = 0; i < 500; ++i) {
    const auto palette = test::random_palette(random, 4, 1.2);
    const std::vector<Influence> influences = {{2, 0.5f}, {0, 0.3f}, {3, 0.2f}};
    const Vec3d wanted(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto bind = solve_bind_position(influences, wanted, palette);
    if (!bind) continue;
    ++solved;
    EXPECT_LT((skinned(*bind, influences, palette) - wanted).norm(), 1e-12);
  }
  EXPECT_GT(solved, 100);
}

TEST(BindPosition, is_not_solved_for_where_bones_cancel) {
  std::vector<Affine3d> palette(2, Affine3d::Identity());
  palette[1].linear() = Eigen::AngleAxisd(3.14159, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const std::vector<Influence> halves = {{0, 0.5f}, {1, 0.5f}};
  EXPECT_FALSE(solve_bind_position(halves, {0.1, 0, 0}, palette))
      << "a wrapper twisted by half a turn has no inside";
  palette[1].linear().setZero();
  EXPECT_FALSE(solve_bind_position(std::vector<Influence>{{1, 1.0f}}, {0.1, 0, 0}, palette));
  palette[1].linear().setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(solve_bind_position(std::vector<Influence>{{1, 1.0f}}, {0.1, 0, 0}, palette));
}

TEST(BindPosition, does_not_mind_the_unit_of_bones) {
  std::vector<Affine3d> palette(2, Affine3d::Identity());
  for (Affine3d& bone : palette) bone.linear() *= 1e-3;
  EXPECT_TRUE(
      solve_bind_position(std::vector<Influence>{{0, 0.5f}, {1, 0.5f}}, {0.1, 0, 0}, palette));
}

}  // namespace
}  // namespace sunder
