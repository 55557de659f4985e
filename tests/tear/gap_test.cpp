// Compares areas of gaps and bores with formulas and with clipping triangle by triangle.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/clip_oracle.h"
#include "support/oracles/source_cover.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::down_at;
using test::make_model;
using test::Random;
using testing::IsEmpty;

double length_of(const Stroke& stroke) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < stroke.size(); ++i)
    length += (stroke[i + 1].tip - stroke[i].tip).norm();
  return length;
}

void expect_sound(const TornModel& model) {
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
}

TEST(Gap, of_a_straight_stroke_on_a_plane_is_width_times_length) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    TornModel model = make_model(test::make_sheet(1 + random.index(20)));
    const ModelPose pose = *bind_pose(model.source());
    TearOptions options;
    options.width = random.uniform(0.001, 0.1);
    const Vec2d from{random.uniform(0.1, 0.9), random.uniform(0.1, 0.9)},
        to{random.uniform(0.1, 0.9), random.uniform(0.1, 0.9)};
    const Stroke stroke = {down_at(from.x(), from.y()), down_at(to.x(), to.y())};
    const auto report = model.tear(pose, stroke, options);
    ASSERT_TRUE(report);
    const double expected = options.width * length_of(stroke);
    EXPECT_NEAR(report->area_removed_posed, expected, 1e-6 * expected);
    EXPECT_NEAR(test::removed_area(model, pose), expected, 1e-6 * expected);
    EXPECT_EQ(count_topology(model.character())->boundary_loops, 2u);
    expect_sound(model);
  }
}

/// A mitred band that does not overlap itself has the area of its middle line times its width.
TEST(Gap, of_a_turning_stroke_is_mitred) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    TornModel model = make_model(test::make_sheet(1 + random.index(20)));
    const ModelPose pose = *bind_pose(model.source());
    TearOptions options;
    options.width = random.uniform(0.001, 0.02);
    const Stroke stroke = test::turning_stroke(random);
    const auto report = model.tear(pose, stroke, options);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->runs, 1u);
    const double expected = options.width * length_of(stroke);
    EXPECT_NEAR(report->area_removed_posed, expected, 1e-6 * expected);
    EXPECT_NEAR(test::removed_area(model, pose), expected, 1e-6 * expected);
    EXPECT_EQ(count_topology(model.character())->boundary_loops, 2u)
        << "one gap, no notch, nothing left inside";
    expect_sound(model);
  }
}

TEST(Gap, at_a_sharp_turn_is_bevelled_and_has_no_spike) {
  TornModel model = make_model(test::make_sheet(12));
  const ModelPose pose = *bind_pose(model.source());
  TearOptions options;
  options.width = 0.04;
  const double turn = 170.0 / 180.0 * std::numbers::pi;
  const Stroke stroke = {down_at(0.2, 0.5), down_at(0.6, 0.5),
                         down_at(0.6 + 0.3 * std::cos(turn), 0.5 + 0.3 * std::sin(turn))};
  const auto report = model.tear(pose, stroke, options);
  ASSERT_TRUE(report);
  EXPECT_EQ(count_topology(model.character())->boundary_loops, 2u);
  expect_sound(model);
  for (const Triangle& triangle : model.character().meshes[0].triangles) {
    if (is_retired(triangle)) continue;
    for (const std::uint32_t v : triangle) {
      const Vec3f& p = model.character().meshes[0].positions[v];
      // A full mitre would reach 0.23 beyond the turn.
      if (v >= model.source().meshes[0].vertex_count()) {
        EXPECT_LT(p.x(), 0.6f + 0.03f);
      }
    }
  }
}

/// The cell that a blade of the given thickness sweeps when it moves without turning.
test::ConvexCell band_cell(const Stroke& stroke, double width) {
  const Vec3d blade = stroke[0].tip - stroke[0].base, motion = stroke[1].base - stroke[0].base;
  const Vec3d normal = motion.cross(blade).normalized();
  test::ConvexCell cell = test::slab(stroke[0].base, normal, 0.5 * width);
  const auto between = [&](const Vec3d& edge, const Vec3d& from, const Vec3d& to) {
    const Vec3d across = normal.cross(edge).normalized();
    const double low = std::min(across.dot(from), across.dot(to)),
                 high = std::max(across.dot(from), across.dot(to));
    cell.push_back({across, high});
    cell.push_back({-across, -low});
  };
  between(blade, stroke[0].base, stroke[1].base);
  between(motion, stroke[0].base, stroke[0].tip);
  return cell;
}

TEST(Gap, equals_clipping_of_each_face_in_any_pose) {
  Random random(3);
  int compared = 0;
  for (int i = 0; i < 400; ++i) {
    SCOPED_TRACE(i);
    const bool is_sheet = random.index(2) == 0;
    const std::uint32_t cells = 2 + random.index(20), sides = 5 + random.index(20);
    TornModel model =
        make_model(is_sheet ? test::make_sheet(cells) : test::make_tube(cells + 2, sides, 3));
    const ModelPose pose = test::random_pose(model.source(), random, 0.6, 1.2);
    const Stroke around =
        test::random_stroke(model.source(), pose, random, random.uniform(0.02, 0.5), 1);
    const Vec3d motion = around[1].base - around[0].base;
    const Stroke stroke = {around[0], {around[0].base + motion, around[0].tip + motion}};
    TearOptions options;
    options.width = random.uniform(0.002, 0.1) * test::posed_diagonal(model.source(), pose);
    options.layers = random.index(2) == 0 ? Layers::all : Layers::nearest;
    const double inside =
        test::clipped_area(model.source(), pose, band_cell(stroke, options.width));
    const auto report = model.tear(pose, stroke, options);
    ASSERT_TRUE(report);
    expect_sound(model);
    // The nearest layer is all or a part of the surface in the cell.
    if (options.layers == Layers::nearest && report->area_removed_posed < 0.999 * inside) continue;
    ++compared;
    EXPECT_NEAR(report->area_removed_posed, inside, 1e-6 * inside);
    EXPECT_NEAR(test::removed_area(model, pose), inside, 1e-5 * inside);
  }
  EXPECT_GT(compared, 250);
}

TEST(Bore, equals_clipping_of_each_face_in_any_pose) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const bool is_sheet = random.index(2) == 0;
    const std::uint32_t cells = 2 + random.index(20), sides = 5 + random.index(20);
    TornModel model =
        make_model(is_sheet ? test::make_sheet(cells) : test::make_tube(cells + 2, sides, 3));
    const ModelPose pose = test::random_pose(model.source(), random, 0.6, 1.2);
    const Blade along = test::random_stroke(model.source(), pose, random, 0.1, 1)[0];
    Bore bore;
    bore.origin = along.base;
    bore.direction = along.tip - along.base;
    bore.depth = random.uniform(0.5, 5) * bore.direction.norm();
    bore.radius = random.uniform(0.003, 0.1) * test::posed_diagonal(model.source(), pose);
    bore.chord_tolerance = random.uniform(0.001, 0.05) * bore.radius;
    const auto report = model.drill(pose, bore);
    ASSERT_TRUE(report);
    expect_sound(model);
    // The prism is inside the cylinder and at most thinner by the tolerance.
    const auto cylinder = [&](double radius) {
      return test::clipped_area(model.source(), pose,
                                test::prism(bore.origin, bore.direction, radius, bore.depth, 720));
    };
    EXPECT_LE(report->area_removed_posed, cylinder(bore.radius) * (1 + 1e-4));
    EXPECT_GE(report->area_removed_posed,
              cylinder(bore.radius - bore.chord_tolerance) * (1 - 1e-6));
    EXPECT_NEAR(test::removed_area(model, pose), report->area_removed_posed,
                1e-5 * report->area_removed_posed);
  }
}

TEST(Bore, of_a_coarse_plane_has_a_round_rim) {
  TornModel model = make_model(test::make_sheet(1));
  Bore bore;
  bore.origin = {0.45, 0.52, 1};
  bore.radius = 0.2;
  bore.depth = 2;
  bore.chord_tolerance = 0.0005;
  const auto report = model.drill(*bind_pose(model.source()), bore);
  ASSERT_TRUE(report);
  expect_sound(model);
  EXPECT_EQ(count_topology(model.character())->boundary_loops, 2u);
  EXPECT_NEAR(report->area_removed_posed, std::numbers::pi * 0.04,
              std::numbers::pi * 0.04 * 2 * 0.0005 / 0.2);
}

}  // namespace
}  // namespace sunder
