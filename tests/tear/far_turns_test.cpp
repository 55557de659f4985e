// Blades that turn by 30 to 170 degrees about a point that is 10 to 1,000 of their lengths away,
// and step back: what they tear is the line on which they stand, once.
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/hard_operations.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/source_cover.h"
#include "support/oracles/torn_invariants.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {

using test::Random;
using testing::IsEmpty;

constexpr double kDegree = std::numbers::pi / 180;

/// A line on the unit sheet, and a stroke along it whose blades meet far above the sheet or below.
struct FarTurn {
  Vec3d begin, end;
  Stroke stroke;
  bool steps_back = false;
};

FarTurn far_turn(Random& random) {
  FarTurn turn;
  const auto place = [&] {
    const double x = random.uniform(0.05, 0.95), y = random.uniform(0.05, 0.95);
    return Vec3d(x, y, 0);
  };
  turn.begin = place();
  turn.end = place();
  const Vec3d way = turn.end - turn.begin, along = way / way.norm(), up(0, 0, 1);
  const double half = 0.5 * random.uniform(30, 170) * kDegree,
               radius = test::any_scale(random, 10, 1000), side = random.index(2) == 0 ? 1 : -1;
  const double length = way.norm() / (2 * radius * std::tan(half));
  const std::uint32_t steps = 2 + random.index(6);
  std::vector<double> angles = {-half};
  const bool may_step_back = random.index(3) > 0;
  while (angles.size() <= steps || angles.back() < half) {
    const double step = std::min(2 * half * random.uniform(0.05, 1.2), 85 * kDegree);  // below 90
    const bool is_back = may_step_back && angles.back() > -half && random.index(3) == 0;
    turn.steps_back |= is_back;
    angles.push_back(std::clamp(angles.back() + (is_back ? -step : step), -half, half));
  }
  for (const double angle : angles) {
    const Vec3d down = length * (std::cos(angle) * -up + side * std::sin(angle) * along);
    const double part = 0.5 + 0.5 * std::tan(angle) / std::tan(half),
                 above = random.uniform(0.1, 0.9);
    const Vec3d at = turn.begin + part * way;
    turn.stroke.push_back({at - above * down, at + (1 - above) * down});
  }
  return turn;
}

/// The borders within the unit sheet, of both sides.
struct TornBorders {
  double length = 0, farthest = 0;  ///< From the line of the stroke.
};

TornBorders torn_borders(const TornModel& model, const FarTurn& turn) {
  const tear::Surface& surface = model.surface();
  const Mesh& mesh = model.character().meshes[0];
  const Vec3d along = (turn.end - turn.begin).normalized();
  TornBorders borders;
  for (std::uint32_t h = 0; h < surface.twin.size(); ++h) {
    if (surface.twin[h] != kNone || surface.has_repeated_point(h / 3)) continue;
    const Triangle& triangle = mesh.triangles[surface.triangle(h / 3).triangle];
    const Vec3d a = mesh.positions[triangle[h % 3]].cast<double>(),
                b = mesh.positions[triangle[(h + 1) % 3]].cast<double>();
    const auto is_outline = [&](int k) { return a[k] == b[k] && (a[k] == 0 || a[k] == 1); };
    if (is_outline(0) || is_outline(1)) continue;
    borders.length += (b - a).norm();
    for (const Vec3d& end : {a, b})
      borders.farthest = std::max(borders.farthest, (end - turn.begin).cross(along).norm());
  }
  return borders;
}

void expect_line_torn(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  const std::uint32_t cells = 1 + random.index(16);
  TornModel model = test::make_model(test::make_sheet(cells));
  const ModelPose pose = *bind_pose(model.source());
  const FarTurn turn = far_turn(random);
  if ((turn.end - turn.begin).norm() < 0.05) return;
  ChangeRecord change;
  const auto report = model.tear(pose, turn.stroke, {}, &change);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
  EXPECT_THAT(test::broken_lips(model, change), IsEmpty());
  // Ends snap to edges and points that are nearer than a thousandth of an edge, and later steps to
  // those that the tear made, within 3 % of the faces there.
  const double expected = (turn.end - turn.begin).norm(), edge = std::numbers::sqrt2 / cells;
  const TornBorders borders = torn_borders(model, turn);
  EXPECT_GT(0.5 * borders.length, 0.99 * expected - 4e-3 * edge);
  if (!turn.steps_back) {
    EXPECT_LT(0.5 * borders.length, 1.01 * expected + 4e-3 * edge);
  }
  EXPECT_LT(borders.farthest, 3e-2 * edge);
  ASSERT_TRUE(model.undo());
  EXPECT_EQ(model.character(), model.source());
}

TEST(FarTurns, tear_the_line_on_which_the_blades_stand) {
  for (int seed = 0; seed < test::stressed(200, 40) && !HasFailure(); ++seed)
    ASSERT_NO_FATAL_FAILURE(expect_line_torn(static_cast<std::uint64_t>(seed)));
}

TEST(FarTurns, remove_the_band_along_that_line) {
  for (int seed = 0; seed < test::stressed(200, 40) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const std::uint32_t cells = 1 + random.index(16);
    TornModel model = test::make_model(test::make_sheet(cells));
    const ModelPose pose = *bind_pose(model.source());
    const FarTurn turn = far_turn(random);
    TearOptions options;
    options.width = random.uniform(0.001, 0.05);
    const auto report = model.tear(pose, turn.stroke, options);
    ASSERT_TRUE(report) << report.error().text();
    ASSERT_THAT(test::broken_laws(model), IsEmpty());
    ASSERT_THAT(test::broken_surface(model), IsEmpty());
    const double length = (turn.end - turn.begin).norm();
    // Stored positions move the outline by less than 1e-7. A step that leaves the band again by
    // less than a thousandth of an edge removes nothing.
    const double beyond = turn.steps_back ? 1e-3 * std::numbers::sqrt2 / cells : 0;
    EXPECT_NEAR(test::removed_area(model, pose), options.width * length,
                2e-7 * (length + options.width) + beyond * options.width);
  }
}

}  // namespace
}  // namespace sunder
