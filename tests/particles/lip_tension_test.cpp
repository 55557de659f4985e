#include "particles/motion/lip_tension.h"

#include <array>
#include <limits>

#include <gtest/gtest.h>

namespace sunder {
namespace {

/// A slit along x with two edges per lip, its lips at y = 0, and three particles per side.
struct Slit {
  std::vector<Vec3f> positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  std::vector<LipEdge> lips = {
      {{0, 1}, {0, 1, 0}}, {{1, 2}, {0, 1, 0}}, {{3, 4}, {0, -1, 0}}, {{4, 5}, {0, -1, 0}}};
  std::vector<ParticleInfluences> influences = {{{0}, {1}}, {{0, 1}, {0.5f, 0.5f}}, {{1}, {1}},
                                                {{2}, {1}}, {{2, 3}, {0.5f, 0.5f}}, {{3}, {1}}};

  [[nodiscard]] std::array<Vec3d, 4> forces(const Tension& tension) const {
    std::array<Vec3d, 4> found;
    found.fill(Vec3d::Zero());
    particles::add_lip_forces(lips, positions, influences, tension, found);
    return found;
  }
};

TEST(lip_tension, parts_the_lips) {
  const auto forces = Slit().forces({3.0, {}});
  for (int p = 0; p < 4; ++p)
    EXPECT_EQ(forces[p], Vec3d(0, p < 2 ? 3 : -3, 0));  // two metres of each lip, two particles
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
  EXPECT_EQ(along({0, 1, 0})[0], Vec3d(0, 2, 0));
  EXPECT_EQ(along({0, -1, 0})[0], Vec3d(0, 2, 0));
  const Vec3d slanted = along({1, 1, 0})[0];
  EXPECT_NEAR((slanted - Vec3d(1, 1, 0)).norm(), 0, 1e-12);
  for (const Vec3d& force : along({std::numeric_limits<double>::quiet_NaN(), 0, 0}))
    EXPECT_EQ(force, Vec3d::Zero());
}

}  // namespace
}  // namespace sunder
