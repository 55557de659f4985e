// What holds for every preset, on a sheet of a metre.

#include <sunder/particles/force_tearing.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "particles/internal/angular_frequency.h"
#include "particles/soft_scene.h"
#include "support/oracles/membrane.h"

namespace sunder {
namespace {

using test::SlitSheet;
using test::SoftScene;

double reach_of(const SoftMaterial& material) {
  return std::sqrt(
      material.membrane_stiffness /
      (material.areal_density * particles::squared_frequency(material.return_frequency)));
}

TEST(presets, are_valid_and_reach_a_tenth_to_a_third_of_a_metre) {
  std::set<std::string> names;
  for (const SoftMaterial& material : material_presets()) {
    EXPECT_TRUE(validate_material(material)) << material.name;
    EXPECT_TRUE(names.insert(material.name).second) << material.name;
    EXPECT_GT(reach_of(material), 0.1) << material.name;
    EXPECT_LT(reach_of(material), 0.33) << material.name;
  }
}

/// Whether a slit of 0.2 m runs on under a tension, and how wide it gapes before.
std::pair<bool, double> runs_on(const SoftMaterial& material, double tension) {
  SlitSheet sheet(160, 0.1, 0.05, material);
  sheet.open(tension);
  const double gap = test::gap_of(sheet).widest();
  // A little more keeps it awake.
  EXPECT_TRUE(sheet.body->set_tension({1.01 * tension, {}}));
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(sheet.body->step(*sheet.model, sheet.pose, 0.1));
  const auto report = tear_overstretched(*sheet.body, *sheet.set, *sheet.model, sheet.pose);
  EXPECT_TRUE(report) << report.error().text();
  return {report && report->has_torn, gap};
}

TEST(presets, gape_as_wide_as_wanted_and_run_on_by_their_toughness) {
  constexpr double kHalfLength = 0.1, kGap = 0.014;
  for (SoftMaterial material : material_presets()) {
    const Result<double> tension = tension_for_gap(material, 2 * kHalfLength, kGap);
    ASSERT_TRUE(tension);
    const auto [has_run, gap] = runs_on(material, *tension);
    EXPECT_FALSE(has_run) << material.name;
    EXPECT_NEAR(gap / kGap, 1, 0.08) << material.name;
    // Twice the tension under which a slit without foundation releases its toughness; the
    // foundation hardly lowers it, because the slit is short relative to the reach.
    material.strength = material.stretch_limit = 0;
    const double critical = std::sqrt(2 * material.toughness * material.membrane_stiffness /
                                      (std::numbers::pi * kHalfLength));
    EXPECT_FALSE(runs_on(material, 0.7 * critical).first) << material.name;
    EXPECT_TRUE(runs_on(material, 2 * critical).first) << material.name;
  }
}

TEST(presets, tear_when_they_are_pulled_apart) {
  for (const SoftMaterial& material : material_presets()) {
    SoftScene scene(test::make_sheet(40), material, 0.06);
    std::vector<std::pair<HoldId, Vec3d>> holds;
    for (std::uint32_t p = 0; p < scene.count(); ++p) {
      const Vec3d at = scene.body->place(p);
      if (at.x() < 0.25 || at.x() > 0.75) holds.emplace_back(*scene.body->hold(p, at), at);
    }
    bool has_torn = false;
    for (int i = 0; i < 200 && !has_torn; ++i) {
      for (const auto& [hold, at] : holds)
        ASSERT_TRUE(
            scene.body->move_hold(hold, at + Vec3d((at.x() < 0.5 ? -0.005 : 0.005) * i, 0, 0)));
      scene.step(1.0 / 60);
      const auto report = tear_overstretched(*scene.body, *scene.set, *scene.model, scene.pose);
      ASSERT_TRUE(report) << report.error().text();
      has_torn = report->has_torn;
      if (has_torn) {
        EXPECT_LT(report->greatest_stretch, 1.1 * material.strength) << material.name;
      }
    }
    EXPECT_TRUE(has_torn) << material.name;
  }
}

}  // namespace
}  // namespace sunder
