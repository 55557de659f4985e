#include "particles/motion/lip_tension.h"

#include <array>
#include <limits>

#include <gtest/gtest.h>

namespace sunder {
namespace {

/// A slit along x with two edges per lip, its lips at y = 0, and two cells per side, the first of
/// which has the middle.
struct Slit {
  std::vector<Vec3f> positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  std::vector<LipEdge> lips = {
      {{0, 1}, {0, 1, 0}}, {{1, 2}, {0, 1, 0}}, {{3, 4}, {0, -1, 0}}, {{4, 5}, {0, -1, 0}}};
  std::vector<Index> owners = {0, 0, 1, 2, 2, 3};

  [[nodiscard]] std::array<Vec3d, 4> forces(const Tension& tension,
                                            std::span<const Mat3d> added = {}) const {
    std::array<Vec3d, 4> found;
    found.fill(Vec3d::Zero());
    particles::add_lip_forces(lips, positions, owners, {tension, added}, found);
    return found;
  }
};

TEST(lip_tension, parts_the_lips) {
  const auto forces = Slit().forces({3.0, {}});
  // Two metres of each lip; the middle and one end are in the first cell.
  EXPECT_EQ(forces[0], Vec3d(0, 4.5, 0));
  EXPECT_EQ(forces[1], Vec3d(0, 1.5, 0));
  EXPECT_EQ(forces[2], Vec3d(0, -4.5, 0));
  EXPECT_EQ(forces[3], Vec3d(0, -1.5, 0));
}

TEST(lip_tension, none_is_no_force) {
  for (const Vec3d& force : Slit().forces({})) EXPECT_EQ(force, Vec3d::Zero());
}

TEST(lip_tension, along_a_direction_pulls_only_lips_across_it) {
  const auto along = [](const Vec3d& direction) {
    return Slit().forces({2.0, [=](const Vec3d&) { return direction; }});
  };
  for (const Vec3d& force : along({1, 0, 0}))
    EXPECT_EQ(force, Vec3d::Zero());  // a cut along the fibres stays closed
  EXPECT_EQ(along({0, 1, 0})[1], Vec3d(0, 1, 0));
  EXPECT_EQ(along({0, -1, 0})[1], Vec3d(0, 1, 0));
  const Vec3d slanted = along({1, 1, 0})[1];
  EXPECT_NEAR((slanted - Vec3d(0.5, 0.5, 0)).norm(), 0, 1e-12);
  for (const Vec3d& force : along({std::numeric_limits<double>::quiet_NaN(), 0, 0}))
    EXPECT_EQ(force, Vec3d::Zero());
}

/// The middle of the slit belongs to one wound and has a share; the ends are tips of others too.
TEST(lip_tension, a_share_lowers_the_pull_of_the_edges_at_its_point) {
  const auto whole = Slit().forces({3.0, {}});
  Tension half{3.0, {}};
  half.shares = {1, 0.5f, 1, 1, 0.5f};  // The last point is beyond the end.
  const auto halved = Slit().forces(half);
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(halved[i], 0.5 * whole[i]) << i;
  half.shares = {0, 1, 1, 0, 1, 1};  // Only the edges at the other ends pull.
  EXPECT_EQ(Slit().forces(half)[0], Vec3d(0, 1.5, 0));
  EXPECT_EQ(Slit().forces(half)[1], whole[1]);
}

TEST(lip_tension, shares_of_one_change_no_bit) {
  Tension whole{3.0, [](const Vec3d&) { return Vec3d(0.3, 0.7, 0); }};
  Tension shared = whole;
  shared.shares.assign(6, 1.0f);
  EXPECT_EQ(Slit().forces(whole), Slit().forces(shared));
}

}  // namespace
}  // namespace sunder
