#include <sunder/tear/blade_force.h>

#include <limits>

#include <gtest/gtest.h>

namespace sunder {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const CuttingResistance kSkin = {2000, 0.002, 0, 1e6};

/// Work of the force along the motion == toughness x area of the section.
TEST(BladeForce, its_work_is_the_energy_of_the_section) {
  for (const double torn : {0.0, 0.001, 0.004})
    for (const double depth : {0.0005, 0.002, 0.03}) {
      const BladeStep step = {torn, depth, {0.003, 0.0, -0.004}};
      const auto force = blade_force(kSkin, step);
      ASSERT_TRUE(force);
      const double work = -(force->newtons * force->direction).dot(step.motion);
      EXPECT_NEAR(work, kSkin.toughness * torn * std::min(depth, kSkin.thickness), 1e-15);
      EXPECT_NEAR(force->direction.norm(), 1, 1e-15);
      EXPECT_LT(force->direction.dot(step.motion), 0);
    }
}

/// It does not depend on the frame rate: half the step tears half the length.
TEST(BladeForce, it_does_not_depend_on_the_frame_rate) {
  const auto whole = blade_force(kSkin, {0.004, 0.01, {0.004, 0, 0}}),
             half = blade_force(kSkin, {0.002, 0.01, {0.002, 0, 0}});
  EXPECT_DOUBLE_EQ(whole->newtons, 2000 * 0.002);
  EXPECT_DOUBLE_EQ(half->newtons, whole->newtons);
}

TEST(BladeForce, friction_is_there_without_a_tear_and_the_device_limits_both) {
  CuttingResistance tissue = kSkin;
  tissue.friction = 50;
  EXPECT_DOUBLE_EQ(blade_force(tissue, {0, 0.01, {0, 0.001, 0}})->newtons, 0.5);
  EXPECT_DOUBLE_EQ(blade_force(tissue, {0, -0.01, {0, 0.001, 0}})->newtons, 0);
  tissue.greatest = 3;
  EXPECT_DOUBLE_EQ(blade_force(tissue, {0.001, 0.01, {0, 1e-9, 0}})->newtons, 3);
}

TEST(BladeForce, a_blade_that_stands_still_feels_none) {
  const auto force = blade_force(kSkin, {0.001, 0.01, {0, 0, 0}});
  EXPECT_EQ(force->newtons, 0);
  EXPECT_EQ(force->direction, Vec3d(0, 0, 0));
}

TEST(BladeForce, bad_input_is_refused) {
  const BladeStep step = {0.001, 0.01, {0.001, 0, 0}};
  const auto code_of = [](const CuttingResistance& tissue, const BladeStep& of) {
    return blade_force(tissue, of).error().code();
  };
  EXPECT_EQ(code_of({-1, 0.002, 0, 1}, step), StatusCode::invalid_argument);
  EXPECT_EQ(code_of({kNan, 0.002, 0, 1}, step), StatusCode::non_finite_value);
  EXPECT_EQ(code_of({1, -0.002, 0, 1}, step), StatusCode::invalid_argument);
  EXPECT_EQ(code_of({1, 0.002, -1, 1}, step), StatusCode::invalid_argument);
  EXPECT_EQ(code_of({1, 0.002, 0, 0}, step), StatusCode::invalid_argument);
  EXPECT_EQ(code_of(kSkin, {-1, 0.01, {1, 0, 0}}), StatusCode::invalid_argument);
  EXPECT_EQ(code_of(kSkin, {1, kNan, {1, 0, 0}}), StatusCode::non_finite_value);
  EXPECT_EQ(code_of(kSkin, {1, 1, {1, kNan, 0}}), StatusCode::non_finite_value);
}

}  // namespace
}  // namespace sunder
