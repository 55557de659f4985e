// Cracks of a source: edges whose two sides coincide in bind space and have different weights.
// Tears across them leave a surface that is closed in bind space closed there.
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/cracked_bodies.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {

using test::Random;
using testing::IsEmpty;

/// A tear without width through one layer or all, or a cut.
Operation opening(const TornModel& model, Random& random) {
  const double angle = random.index(3) == 0 ? 0.0 : 0.5;  // at bind the sides coincide
  if (random.index(3) == 0) {
    CutOperation cut;
    cut.pose = test::random_pose(model.source(), random, angle);
    const auto positions = test::posed_positions(model.source(), 0, std::get<ModelPose>(cut.pose));
    cut.cut.point = positions[random.index(static_cast<std::uint32_t>(positions.size()))];
    if (random.index(2) == 0) cut.cut.point += 1e-3 * random.direction();
    cut.cut.normal = random.direction();
    return cut;
  }
  TearOperation tear;
  const ModelPose pose = test::random_pose(model.source(), random, angle);
  tear.pose = pose;
  tear.stroke = test::random_stroke(model.source(), pose, random, random.uniform(0.1, 0.8),
                                    1 + random.index(6));
  if (random.index(3) == 0) tear.options.layers = Layers::all;
  return tear;
}

TEST(Cracks, of_a_source_are_found_from_both_sides) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    EXPECT_THAT(tear::build_surface(test::closed_body(random)).cracks, IsEmpty());
    const Character cracked = test::cracked_body(random);
    const tear::Surface surface = tear::build_surface(cracked);
    EXPECT_THAT(test::unmatched_edges(cracked), IsEmpty());
    // The body is closed in bind space, so each border is a side of a crack.
    const auto borders = std::count(surface.twin.begin(), surface.twin.end(), kNone);
    EXPECT_EQ(surface.cracks.size(), static_cast<std::size_t>(borders));
    for (const auto& [here, there] : surface.cracks) EXPECT_EQ(surface.across_crack(there), here);
  }
}

/// The lips of a tear that was saved are no crack: they are apart on purpose.
TEST(Cracks, lips_are_none) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    auto model = TornModel::create(std::make_shared<const Character>(test::closed_body(random)));
    ASSERT_TRUE(model);
    ASSERT_TRUE(test::play(*model, opening(*model, random)));
    EXPECT_THAT(tear::build_surface(model->character()).cracks, IsEmpty());
  }
}

TEST(Cracks, a_surface_that_is_closed_at_bind_stays_closed) {
  int torn = 0, split = 0;
  for (int seed = 0; seed < test::stressed(300, 40) && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    auto model = TornModel::create(std::make_shared<const Character>(test::cracked_body(random)));
    ASSERT_TRUE(model) << model.error().text();
    const std::uint64_t before = model->digest();
    const Operation operation = opening(*model, random);
    ChangeRecord change;
    const auto report = test::play(*model, operation, &change);
    ASSERT_TRUE(report) << report.error().text();
    torn += report->runs > 0 ? 1 : 0;
    split += report->blocked == 0 ? 1 : 0;
    EXPECT_THAT(test::broken_laws(*model), IsEmpty());
    EXPECT_THAT(test::broken_lips(*model, change), IsEmpty());
    if (report->blocked == 0) {
      EXPECT_THAT(test::unmatched_edges(model->character()), IsEmpty());
    }
    if (model->undo_count() > 0) {
      ASSERT_TRUE(model->undo());
    }
    EXPECT_EQ(model->digest(), before);
  }
  EXPECT_GT(torn, test::stressed(250, 40));
  EXPECT_GT(split, test::stressed(295, 40));
}

}  // namespace
}  // namespace sunder
