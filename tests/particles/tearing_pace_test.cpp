#include <sunder/particles/force_tearing.h>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "particles/soft_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::SoftScene;

void slit(SoftScene& scene, const Stroke& stroke) {
  ChangeRecord change;
  ASSERT_TRUE(scene.model->tear(scene.pose, stroke, {}, &change));
  ASSERT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
  ASSERT_TRUE(scene.body->set_tension({2.0, {}}));
  scene.run(0.5);
}

TEST(tearing_pace, is_at_most_the_speed_and_the_length) {
  SoftMaterial material;
  material.toughness = 0.001;
  for (const double speed : {0.05, 0.2, 0.5})
    for (const double metres : {0.004, 0.02}) {
      SoftScene scene(test::make_sheet(60), material);
      slit(scene, {test::down_at(0.45, 0.503), test::down_at(0.55, 0.503)});
      double torn = 0;
      int calls = 0;
      for (int i = 0; i < 60; ++i) {
        scene.step(1.0 / 60);
        const auto report = tear_overstretched(*scene.body, *scene.set, *scene.model, scene.pose,
                                               {0.5, metres, speed});
        ASSERT_TRUE(report);
        EXPECT_GT(report->greatest_release, 0);
        EXPECT_LE(report->tear.length_posed, metres * 1.01);
        torn += report->tear.length_posed;
        ++calls;
      }
      EXPECT_LE(torn, speed * calls / 60 + metres) << speed << " " << metres;
      EXPECT_GE(torn, 0.8 * std::min(speed, metres * 60) - metres) << speed << " " << metres;
    }
}

TEST(tearing_pace, small_pieces_stay) {
  SoftMaterial material;
  material.toughness = 0.001;
  const auto cut_off = [&](double least_area) {
    SoftScene scene(test::make_sheet(60), material);
    // A strip of 0.1 x 0.3 m at the edge, cut but for its end.
    slit(scene, {test::down_at(0.0, 0.503), test::down_at(0.3, 0.503), test::down_at(0.3, 0.62),
                 test::down_at(0.06, 0.62)});
    std::size_t pieces = 0;
    std::uint32_t redo = 0;
    for (int i = 0; i < 60; ++i) {
      scene.step(1.0 / 60);
      ForceTearingOptions options;
      options.least_piece_area = least_area;
      const auto report =
          tear_overstretched(*scene.body, *scene.set, *scene.model, scene.pose, options);
      EXPECT_TRUE(report);
      pieces += report->tear.pieces.size();
      redo += scene.model->redo_count();
    }
    EXPECT_EQ(redo, 0u);
    return pieces;
  };
  EXPECT_GT(cut_off(0), 0u);
  EXPECT_EQ(cut_off(1), 0u);
}

TEST(tearing_pace, faults_are_named) {
  SoftScene scene(test::make_sheet(8));
  for (const ForceTearingOptions& options :
       {ForceTearingOptions{0.5, 1, 0}, ForceTearingOptions{0.5, 1, std::nan("")},
        ForceTearingOptions{0.5, 1, 1, -1}}) {
    const auto report =
        tear_overstretched(*scene.body, *scene.set, *scene.model, scene.pose, options);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code(), StatusCode::invalid_argument);
  }
}

}  // namespace
}  // namespace sunder
