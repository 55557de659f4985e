// The gap of a wound under a tension, and the tension for a gap, by the formulas for large sheets.

#include <sunder/particles/material.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "particles/frequency_of.h"
#include "particles/internal/angular_frequency.h"
#include "particles/motion/slit_gap.h"
#include "support/machine/random.h"
#include "support/oracles/membrane.h"
#include "support/oracles/slit_opening.h"

namespace sunder {
namespace {

TEST(wound_gap, is_that_of_the_integral_equation_within_a_thousandth) {
  for (double half_length = 0.002; half_length < 16; half_length *= 1.7)
    EXPECT_NEAR(particles::slit_gap(half_length) / (half_length * test::slit_opening(half_length)),
                1, 1e-3)
        << half_length;
}

TEST(wound_gap, has_the_closed_forms_of_short_and_long_wounds) {
  SoftMaterial material;
  const double foundation =
                   material.areal_density * particles::squared_frequency(material.return_frequency),
               reach = std::sqrt(material.membrane_stiffness / foundation);
  // An ellipse as high as 2 T a / S; a long slit gapes by 2 T / sqrt(S rho k).
  EXPECT_NEAR(*gap_under_tension(material, 2e-4 * reach, 3),
              3 * 2e-4 * reach / material.membrane_stiffness, 1e-7 * reach);
  EXPECT_NEAR(*gap_under_tension(material, 40 * reach, 3),
              6 / std::sqrt(material.membrane_stiffness * foundation), 1e-6);
  EXPECT_EQ(particles::slit_gap(std::numeric_limits<double>::infinity()), 1);
  material.return_frequency = 0;
  EXPECT_DOUBLE_EQ(*gap_under_tension(material, 0.3, 3), 3 * 0.3 / material.membrane_stiffness);
}

TEST(wound_gap, is_that_of_finite_elements) {
  test::Random random(20);
  for (int i = 0; i < 12; ++i) {
    SoftMaterial material;
    material.membrane_stiffness = std::pow(10, random.uniform(-1, 3));
    material.areal_density = std::pow(10, random.uniform(-1, 1));
    const double reach = random.uniform(0.04, 0.2), half_length = random.uniform(0.08, 0.2);
    material.return_frequency =
        test::frequency_of(material.membrane_stiffness / (material.areal_density * reach * reach));
    const double gap = 0.1 * half_length;
    const Result<double> tension = tension_for_gap(material, 2 * half_length, gap);
    ASSERT_TRUE(tension);
    const test::SlitSheet sheet(160, half_length, 0.2, material);
    EXPECT_NEAR(test::reference_gap(sheet, *tension).widest() / gap, 1, 0.02)
        << "reach " << reach << ", half length " << half_length;
  }
}

TEST(wound_gap, and_the_tension_for_it_are_inverse_to_one_another) {
  test::Random random(21);
  for (int i = 0; i < 1000; ++i) {
    SoftMaterial material;
    const auto any = [&](double low, double high) {
      return std::pow(10, random.uniform(low, high));
    };
    material.membrane_stiffness = any(-12, 12);
    material.areal_density = any(-12, 12);
    material.return_frequency = test::frequency_of(any(-12, 12));
    const double length = any(-12, 12), gap = any(-12, 12);
    const Result<double> tension = tension_for_gap(material, length, gap);
    ASSERT_TRUE(tension);
    ASSERT_TRUE(std::isfinite(*tension) && *tension > 0);
    if (*tension > 1e12) continue;
    const Result<double> again = gap_under_tension(material, length, *tension);
    ASSERT_TRUE(again);
    EXPECT_NEAR(*again / gap, 1, 1e-12);
    // A longer wound gapes more, and a greater tension opens it farther.
    EXPECT_GE(*gap_under_tension(material, std::min(1e12, 1.1 * length), *tension),
              (1 - 1e-12) * *again);
  }
}

TEST(wound_gap, refuses_what_has_no_gap) {
  const auto refused = [](const Result<double>& result, const char* name, StatusCode code) {
    ASSERT_FALSE(result) << name;
    EXPECT_EQ(result.error().code(), code);
    EXPECT_NE(result.error().text().find(name), std::string::npos) << result.error().text();
  };
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  SoftMaterial material;
  for (const double bad : {0.0, -1.0, 1e13})
    refused(tension_for_gap(material, bad, 0.01), "wound_length", StatusCode::invalid_argument);
  for (const double bad : {-1.0, 1e13}) {
    refused(tension_for_gap(material, 0.1, bad), "gap", StatusCode::invalid_argument);
    refused(gap_under_tension(material, 0.1, bad), "tension", StatusCode::invalid_argument);
  }
  refused(tension_for_gap(material, kNaN, 0.01), "wound_length", StatusCode::non_finite_value);
  refused(tension_for_gap(material, 0.1, kNaN), "gap", StatusCode::non_finite_value);
  refused(gap_under_tension(material, 0.1, kNaN), "tension", StatusCode::non_finite_value);
  EXPECT_EQ(*tension_for_gap(material, 0.1, 0), 0);
  material.membrane_stiffness = 0;
  refused(gap_under_tension(material, 0.1, 1), "membrane_stiffness", StatusCode::invalid_argument);
  material.membrane_stiffness = kNaN;
  refused(gap_under_tension(material, 0.1, 1), "membrane_stiffness", StatusCode::non_finite_value);
}

}  // namespace
}  // namespace sunder
