// Tears that cross older tears tear their walls too: what comes free without walls does with them.
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::make_model;
using test::Random;

/// A circle around the middle of a unit sheet that goes on past its beginning, drawn by an unsteady
/// hand.
Stroke unsteady_circle(double turns, double noise, Random& random) {
  constexpr int kBlades = 60;
  Stroke stroke;
  for (int i = 0; i <= kBlades; ++i) {
    const double angle = 2 * std::numbers::pi * turns * i / kBlades;
    const double radius = 0.3 * (1 + random.uniform(-noise, noise));
    stroke.push_back(
        test::down_at(0.503 + radius * std::cos(angle), 0.501 + radius * std::sin(angle)));
  }
  return stroke;
}

/// Whether a piece of about the size of the disc within the circle came free.
bool is_disc_free(const TornModel& model, const TearReport& report) {
  for (const TornPiece& piece : report.pieces) {
    const auto described = model.describe_piece(piece);
    EXPECT_TRUE(described);
    if (described && described->area_posed > 0.2) return true;
  }
  return false;
}

TEST(TornWalls, set_a_disc_free_however_deep_they_are) {
  int free = 0;
  for (int seed = 0; seed < test::stressed(20, 20) && !HasFailure(); ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const Stroke circle =
        unsteady_circle(random.uniform(1.05, 1.8), random.uniform(0, 0.03), random);
    const Character sheet = test::make_sheet(12 + random.index(30));
    const ModelPose pose = *bind_pose(sheet);
    TornModel bare = make_model(sheet);
    const auto without = bare.tear(pose, circle);
    ASSERT_TRUE(without);
    if (!is_disc_free(bare, *without)) continue;  // the hand left a bridge
    ++free;
    for (const double depth : {0.002, 0.01, 0.03}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", depth " << depth);
      TornModel model = make_model(sheet);
      const auto report = model.tear(pose, circle, {0, Layers::nearest, depth});
      ASSERT_TRUE(report);
      EXPECT_TRUE(is_disc_free(model, *report));
      ASSERT_THAT(test::broken_laws(model), testing::IsEmpty());
      ASSERT_THAT(test::broken_surface(model), testing::IsEmpty());
    }
  }
  EXPECT_GT(free, 10);
}

TEST(TornWalls, below_a_gap_are_removed_with_it) {
  int free = 0;
  for (int seed = 0; seed < test::stressed(20, 20) && !HasFailure(); ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const Stroke circle =
        unsteady_circle(random.uniform(1.05, 1.8), random.uniform(0, 0.005), random);
    const Character sheet = test::make_sheet(12 + random.index(30));
    const ModelPose pose = *bind_pose(sheet);
    const double width = random.uniform(0.005, 0.02), depth = random.uniform(0.002, 0.03);
    TornModel bare = make_model(sheet);
    const auto without = bare.tear(pose, circle, {width, Layers::nearest, 0});
    ASSERT_TRUE(without);
    if (!is_disc_free(bare, *without)) continue;
    ++free;
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    TornModel model = make_model(sheet);
    const auto report = model.tear(pose, circle, {width, Layers::nearest, depth});
    ASSERT_TRUE(report);
    EXPECT_TRUE(is_disc_free(model, *report));
    ASSERT_THAT(test::broken_laws(model), testing::IsEmpty());
    ASSERT_THAT(test::broken_surface(model), testing::IsEmpty());
    ASSERT_TRUE(model.undo());
    EXPECT_EQ(model.character(), model.source());
  }
  EXPECT_GT(free, 10);
}

TEST(TornWalls, of_an_earlier_operation_part_where_a_tear_crosses_them) {
  for (int seed = 0; seed < test::stressed(40, 20) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    TornModel model = make_model(test::make_sheet(12 + random.index(30)));
    const ModelPose pose = *bind_pose(model.source());
    const double depth = random.uniform(0.005, 0.04), angle = random.uniform(-1.2, 1.2);
    const Vec2d along(0.3 * std::cos(angle), 0.3 * std::sin(angle));
    const Stroke first = {test::down_at(0.503 - along.x(), 0.501 - along.y()),
                          test::down_at(0.503 + along.x(), 0.501 + along.y())},
                 across = {test::down_at(0.507, -0.1), test::down_at(0.511, 0.4),
                           test::down_at(0.498, 1.1)};  // from border to border
    ASSERT_TRUE(model.tear(pose, first, {0, Layers::nearest, depth}));
    const auto report = model.tear(pose, across, {0, Layers::nearest, depth});
    ASSERT_TRUE(report);
    EXPECT_EQ(report->pieces.size(), 1u);
    ASSERT_THAT(test::broken_laws(model), testing::IsEmpty());
    ASSERT_THAT(test::broken_surface(model), testing::IsEmpty());
    ASSERT_TRUE(model.undo());
    ASSERT_TRUE(model.undo());
    EXPECT_EQ(model.character(), model.source());
  }
}

}  // namespace
}  // namespace sunder
