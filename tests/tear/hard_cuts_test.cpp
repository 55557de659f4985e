// Planes that touch closed bodies: near and through vertices, along edges, through rings of them,
// and in faces. The sides are compared with a clip of each triangle in double.
#include "support/models/hard_cuts.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/cut_bodies.h"
#include "support/models/make_model.h"
#include "support/oracles/side_oracle.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::ExactSides;
using test::HardCut;
using test::make_model;
using test::PlaneFamily;
using test::Random;
using test::Solid;
using testing::IsEmpty;

PlaneCut plane_of(const HardCut& hard, bool with_caps) {
  PlaneCut cut;
  cut.point = hard.point;
  cut.normal = hard.normal;
  cut.caps = with_caps;
  return cut;
}

/// What is wrong with the sides of a body that was cut; empty if nothing is.
std::string fault_of(const HardCut& hard, const ExactSides& exact, bool with_caps) {
  TornModel model = make_model(test::character_of(hard.body));
  const auto report = model.cut(*bind_pose(model.source()), plane_of(hard, with_caps));
  if (!report) return std::string(report.error().text());
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  const auto sides = test::sides_of(model, hard.point, hard.normal);
  for (std::size_t side = 0; side < 2; ++side)
    if (std::string fault = fault_of_side(sides[side], with_caps, side, exact, hard.point);
        !fault.empty())
      return fault;
  return with_caps && report->open_sections > 0 ? "sections are open" : "";
}

class HardCuts : public testing::TestWithParam<PlaneFamily> {};

TEST_P(HardCuts, leave_on_each_side_what_a_clip_leaves) {
  const int count = test::stressed(100, 20);
  int wrong = 0;
  for (int seed = 0; seed < count; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const HardCut hard = random_hard_cut(GetParam(), random);
    const ExactSides exact = exact_sides(hard.body, hard.point, hard.normal);
    ASSERT_GT(exact.volume, 0) << hard.body_name;
    for (const bool with_caps : {false, true})
      if (const std::string fault = fault_of(hard, exact, with_caps); !fault.empty()) {
        ++wrong;
        std::cout << "  seed " << seed << ", " << hard.body_name << (with_caps ? ", caps: " : ": ")
                  << fault << '\n';
        break;
      }
  }
  EXPECT_LE(wrong, count / 50);
}

INSTANTIATE_TEST_SUITE_P(Families, HardCuts, testing::ValuesIn(test::kPlaneFamilies),
                         [](const auto& family) {
                           std::string name = name_of(family.param);
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

// ---- Single faces.

/// A step: two boxes side by side of which the second is half as high, as one body.
Solid make_step() {
  Solid step;
  // The outline in x and z, counterclockwise, extruded along y.
  const std::vector<Vec2d> outline = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const double y : {0.0, 1.0})
    for (const Vec2d& at : outline) step.positions.emplace_back(at.x(), y, at.y());
  for (const Triangle& t : {Triangle{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}}) {
    step.triangles.push_back(t);
    step.triangles.push_back({t[0] + 6, t[2] + 6, t[1] + 6});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    step.triangles.push_back({i, i + 6, j + 6});
    step.triangles.push_back({i, j + 6, j});
  }
  return step;
}

/// Area of the surface on one side after a cut of z = 1.
struct StepSides {
  TearReport report;
  std::array<double, 2> areas = {};
};
StepSides cut_step(double z, double direction, bool with_caps) {
  TornModel model = make_model(test::character_of(make_step()));
  PlaneCut cut;
  cut.point = {0, 0, z};
  cut.normal = {0, 0, direction};
  cut.caps = with_caps;
  StepSides result;
  const auto report = model.cut(*bind_pose(model.source()), cut);
  EXPECT_TRUE(report);
  result.report = *report;
  const auto sides = test::sides_of(model, cut.point, Vec3d(0, 0, 1));
  for (std::size_t side = 0; side < 2; ++side)
    for (const Triangle& t : sides[side].triangles)
      result.areas[side] +=
          0.5 * Vec3d(sides[side].positions[t[1]] - sides[side].positions[t[0]])
                    .cross(Vec3d(sides[side].positions[t[2]] - sides[side].positions[t[0]]))
                    .norm();
  return result;
}

TEST(FacesInPlane, stay_with_the_body_behind_them_where_the_plane_goes_on) {
  for (const double direction : {1.0, -1.0})
    for (const bool with_caps : {false, true}) {
      SCOPED_TRACE(testing::Message() << direction << (with_caps ? ", caps" : ""));
      const StepSides sides = cut_step(1, direction, with_caps);
      // Below: a box of 2 x 1 x 1 without the section of 1 x 1, but with the tread beside it.
      EXPECT_NEAR(sides.areas[0], with_caps ? 10 : 9, 1e-6);
      EXPECT_NEAR(sides.areas[1], with_caps ? 6 : 5, 1e-6);
      EXPECT_NEAR(sides.report.length_posed, 4, 1e-6) << "the section's outline alone is opened";
      EXPECT_EQ(sides.report.caps, with_caps ? 2u : 0u);
      EXPECT_EQ(sides.report.open_sections, 0u);
      EXPECT_EQ(sides.report.pieces.size(), 2u);
    }
}

TEST(FacesInPlane, are_not_opened_where_the_plane_only_touches) {
  for (const double z : {0.0, 2.0})
    for (const double direction : {1.0, -1.0}) {
      SCOPED_TRACE(testing::Message() << z << " " << direction);
      const StepSides sides = cut_step(z, direction, true);
      EXPECT_EQ(sides.report.runs, 0u);
      EXPECT_EQ(sides.report.caps, 0u);
      EXPECT_EQ(sides.report.points_added, 0u);
      EXPECT_NEAR(sides.areas[0] + sides.areas[1], 14, 1e-6);
    }
}

/// An open surface: the step without its upper face and the wall behind it.
TEST(FacesInPlane, of_an_open_surface_go_by_their_normal_too) {
  Solid step = make_step();
  std::erase_if(step.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
      return step.positions[v].z() == 2 || step.positions[v].x() == 0;
    });
  });
  TornModel model = make_model(test::character_of(step));
  PlaneCut cut;
  cut.point = {0, 0, 1};
  const auto report = model.cut(*bind_pose(model.source()), cut);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->runs, 1u);
  EXPECT_NEAR(report->length_posed, 3, 1e-6) << "three sides of the section";
  EXPECT_EQ(report->pieces.size(), 2u);
}

}  // namespace
}  // namespace sunder
