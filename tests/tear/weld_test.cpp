// A weld closes wounds: the surface is joined as it was before they were torn.

#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>

#include <limits>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/checked.h"
#include "support/models/atlas_tube.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::checked;
using test::Random;
using testing::IsEmpty;

/// The shape of a surface, whatever points lie on it.
struct Shape {
  std::uint32_t loops = 0, components = 0, non_manifold = 0;

  bool operator==(const Shape&) const = default;
};

Shape shape_of(const Character& character) {
  const TopologyCounts counts = checked(count_topology(character));
  return {counts.boundary_loops, counts.components, counts.non_manifold_edges};
}

Character source_for(Random& random) {
  switch (random.index(4)) {
    case 0: return test::make_sheet(2 + random.index(10));
    case 1: return test::make_atlas_tube(4 + random.index(8), 6 + random.index(10));
    case 2: {
      Character ball = test::make_bumpy_ball(100 + random.index(400));
      test::rig_along(ball, 3);
      return ball;
    }
    default: return test::random_character(random);
  }
}

void expect_sound(const TornModel& model) {
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
}

struct Sums {
  std::uint32_t welds = 0, blocked = 0, runs = 0;
};

/// Tears a model at random, welds all wounds, and goes back and forth.
void weld_all(std::uint64_t seed, std::uint32_t operations, bool has_fillings, Sums& sums) {
  SCOPED_TRACE(seed);
  Random random(seed);
  auto model = checked(TornModel::create(std::make_shared<const Character>(source_for(random))));
  const std::uint64_t untorn = model.digest();
  std::uint32_t done = 0;
  for (std::uint32_t i = 0; i < operations; ++i)
    done += checked(test::play(model, test::random_lossless_operation(model, random, has_fillings)))
                .runs > 0;
  if (done == 0) return;
  const std::uint64_t torn = model.digest();
  const ModelPose pose = test::random_pose(model.source(), random);
  ChangeRecord change;
  const TearReport report = checked(model.weld(pose, {}, &change));
  expect_sound(model);
  if (report.blocked == 0) {
    EXPECT_EQ(shape_of(model.character()), shape_of(model.source()));
  }
  sums.blocked += report.blocked;
  sums.runs += report.runs;
  if (report.runs == 0) return;
  ++sums.welds;
  EXPECT_FALSE(scars_of(model).empty());
  const std::uint64_t welded = model.digest();
  ChangeRecord undone, redone;
  ASSERT_TRUE(model.undo(&undone));
  EXPECT_EQ(model.digest(), torn);
  EXPECT_TRUE(scars_of(model).empty());
  EXPECT_EQ(undone.welded, change.welded);
  ASSERT_TRUE(model.redo(&redone));
  EXPECT_EQ(model.digest(), welded);
  EXPECT_EQ(redone.welded, change.welded);
  // Torn and welded once more.
  (void)checked(test::play(model, test::random_lossless_operation(model, random, false)));
  expect_sound(model);
  (void)checked(model.weld(pose, {}));
  expect_sound(model);
  while (model.undo_count() > 0) ASSERT_TRUE(model.undo());
  EXPECT_EQ(model.digest(), untorn);
}

TEST(Weld, ClosesASingleWoundWithoutATrace) {
  Sums sums;
  for (std::uint64_t seed = 0; seed < 200; ++seed) weld_all(seed, 1, false, sums);
  EXPECT_GT(sums.welds, 100u);
  EXPECT_EQ(sums.blocked, 0u);
}

TEST(Weld, ClosesWoundsThatCrossOneAnother) {
  Sums sums;
  for (std::uint64_t seed = 0; seed < 200; ++seed) weld_all(seed, 4, false, sums);
  EXPECT_GT(sums.welds, 100u);
  EXPECT_EQ(sums.blocked, 0u);
}

TEST(Weld, RemovesTheWallsAndCapsOfWhatItCloses) {
  Sums sums;
  for (std::uint64_t seed = 0; seed < 200; ++seed) weld_all(seed, 3, true, sums);
  EXPECT_GT(sums.welds, 100u);
  EXPECT_EQ(sums.blocked, 0u);
}

/// A place on the lips of an operation, posed.
Vec3d place_on_lips(const TornModel& model, const ChangeRecord& change, const ModelPose& pose,
                    Random& random) {
  const LipPair& pair = change.lips[random.index(static_cast<std::uint32_t>(change.lips.size()))];
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m) {
    const auto posed = test::posed_positions(model.character(), m, pose);
    const Mesh& mesh = model.character().meshes[m];
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::uint32_t k = 0; k < 3 && !is_retired(mesh.triangles[t]); ++k)
        if (model.point_at(m, t, k) == pair.left) return posed[mesh.triangles[t][k]];
  }
  return Vec3d::Zero();
}

TEST(Weld, HealsAWoundFromAPlaceOn) {
  std::uint32_t healed = 0, steps = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto model = checked(TornModel::create(std::make_shared<const Character>(source_for(random))));
    TearOperation tear = test::random_tear(model, random, false);
    const ModelPose pose = std::get<ModelPose>(tear.pose);
    const double diagonal = test::posed_diagonal(model.source(), pose);
    if (seed % 2 == 0) tear.options.wall_depth = 0.02 * diagonal;
    ChangeRecord change;
    const TearReport torn = checked(test::play(model, tear, &change));
    if (torn.runs != 1 || change.lips.empty()) continue;
    const Vec3d near = place_on_lips(model, change, pose, random);
    double welded = 0, before = -1;
    for (double reach = 0.01 * diagonal; welded > before || reach < 2 * diagonal; reach *= 1.4) {
      before = welded;
      const TearReport report = checked(model.weld(pose, {{near}, reach}));
      welded += report.length_posed;
      EXPECT_LE(report.runs, 1u);
      EXPECT_EQ(report.blocked, 0u);
      expect_sound(model);
      steps += report.runs;
    }
    EXPECT_NEAR(welded, torn.length_posed, 5e-3 * diagonal);
    EXPECT_EQ(shape_of(model.character()), shape_of(model.source()));
    ++healed;
  }
  EXPECT_GT(healed, 75u);
  EXPECT_GT(steps, 2 * healed);  // a bit at a time
}

TEST(Weld, ClosesTheWoundThatIsNear) {
  auto model = checked(TornModel::create(std::make_shared<const Character>(test::make_sheet(10))));
  const ModelPose pose = checked(bind_pose(model.source()));
  for (const double y : {0.25, 0.75})
    (void)checked(model.tear(pose, Stroke{test::down_at(0.2, y), test::down_at(0.8, y)}));
  const TearReport report = checked(model.weld(pose, {{Vec3d(0.5, 0.7, 0)}, 0}));
  EXPECT_EQ(report.runs, 1u);
  EXPECT_NEAR(report.length_posed, 0.6, 1e-6);
  EXPECT_EQ(shape_of(model.character()).loops, 2u);  // the sheet's own, and the other wound
  // Now the other one is the nearest.
  EXPECT_NEAR(checked(model.weld(pose, {{Vec3d(0.5, 0.7, 0)}, 0})).length_posed, 0.6, 1e-6);
  EXPECT_EQ(shape_of(model.character()), shape_of(model.source()));
  EXPECT_EQ(checked(model.weld(pose, {})).runs, 0u);
  EXPECT_EQ(model.undo_count(), 4u);  // a weld that finds nothing is no operation
}

TEST(Weld, MarksScars) {
  auto model = checked(TornModel::create(std::make_shared<const Character>(test::make_sheet(10))));
  const ModelPose pose = checked(bind_pose(model.source()));
  (void)checked(model.tear(pose, Stroke{test::down_at(0.2, 0.33), test::down_at(0.8, 0.33)}));
  Character marked = model.character();
  mark_scars(model, marked);
  EXPECT_EQ(marked, model.character());
  (void)checked(model.weld(pose, {}));
  marked = model.character();
  mark_scars(model, marked);
  const CustomAttribute& scar = marked.meshes[0].custom_attributes.back();
  EXPECT_EQ(scar.name, kScarAttribute);
  const Mesh& mesh = marked.meshes[0];
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) {
      const Vec3f& at = mesh.positions[vertex];
      const bool is_on_wound =
          std::abs(at.y() - 0.33f) < 1e-6f && at.x() > 0.199f && at.x() < 0.801f;
      EXPECT_EQ(scar.values[vertex], is_on_wound ? 1.0f : 0.0f);
    }
  EXPECT_EQ(validate_character(marked).code(), StatusCode::ok);
}

TEST(Weld, LeavesGapsAndBoresOpen) {
  auto model = checked(TornModel::create(std::make_shared<const Character>(test::make_sheet(10))));
  const ModelPose pose = checked(bind_pose(model.source()));
  TearOptions gap;
  gap.width = 0.02;
  (void)checked(model.tear(pose, Stroke{test::down_at(0.2, 0.3), test::down_at(0.8, 0.3)}, gap));
  Bore bore;
  bore.origin = {0.5, 0.7, 1};
  bore.radius = 0.05;
  bore.depth = 2;
  (void)checked(model.drill(pose, bore));
  const std::uint64_t before = model.digest();
  EXPECT_EQ(checked(model.weld(pose, {})).runs, 0u);
  EXPECT_EQ(model.digest(), before);
}

TEST(Weld, RefusesPlacesThatAreNone) {
  auto model = checked(TornModel::create(std::make_shared<const Character>(test::make_sheet(4))));
  const ModelPose pose = checked(bind_pose(model.source()));
  (void)checked(model.tear(pose, Stroke{test::down_at(0.2, 0.3), test::down_at(0.8, 0.3)}));
  const std::uint64_t before = model.digest();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(model.weld(pose, {{Vec3d(0, nan, 0)}, 0}).error().code(), StatusCode::non_finite_value);
  EXPECT_EQ(model.weld(pose, {{Vec3d(0, 1e61, 0)}, 0}).error().code(),
            StatusCode::invalid_argument);
  EXPECT_FALSE(model.weld(pose, {{}, -1}));
  EXPECT_FALSE(model.weld(pose, {{}, nan}));
  EXPECT_FALSE(model.weld({}, {}));
  EXPECT_EQ(model.digest(), before);
  EXPECT_EQ(model.undo_count(), 1u);
}

}  // namespace
}  // namespace sunder
