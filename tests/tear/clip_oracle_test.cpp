// Checks the reference for gaps and bores on areas that are known.
#include "support/oracles/clip_oracle.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/rigs.h"
#include "support/oracles/source_cover.h"

namespace sunder {
namespace {

using test::ConvexCell;
using test::Random;

double whole_area(const Character& character, const ModelPose& pose) {
  return test::clipped_area(character, pose, {});
}

ConvexCell box(const Vec3d& low, const Vec3d& high) {
  ConvexCell cell;
  for (int axis = 0; axis < 3; ++axis) {
    cell.push_back({Vec3d::Unit(axis), high[axis]});
    cell.push_back({-Vec3d::Unit(axis), -low[axis]});
  }
  return cell;
}

TEST(ClipOracle, of_a_flat_sheet_is_the_area_in_the_cell) {
  const Character sheet = test::make_sheet(7);
  const ModelPose pose = *bind_pose(sheet);
  EXPECT_NEAR(whole_area(sheet, pose), 1.0, 1e-6);
  EXPECT_NEAR(test::clipped_area(sheet, pose, box({0.13, 0.2, -1}, {0.55, 0.9, 1})), 0.42 * 0.7,
              1e-6);
  EXPECT_EQ(test::clipped_area(sheet, pose, box({0.1, 0.2, 0.1}, {0.6, 0.9, 1})), 0.0);
  EXPECT_NEAR(test::clipped_area(sheet, pose, test::slab({0.5, 0.5, 0}, {3, 0, 0}, 0.1)), 0.2,
              1e-6);
  const double sides = 17, radius = 0.3;
  const double polygon = 0.5 * sides * radius * radius * std::sin(2 * 3.14159265358979 / sides);
  EXPECT_NEAR(
      test::clipped_area(sheet, pose, test::prism({0.5, 0.5, 1}, {0, 0, -1}, radius, 2, 17)),
      polygon, 1e-6);
  EXPECT_EQ(
      test::clipped_area(sheet, pose, test::prism({0.5, 0.5, 1}, {0, 0, -1}, radius, 0.9, 17)), 0.0)
      << "too short";
}

TEST(ClipOracle, of_a_union_counts_shared_parts_once) {
  const Character sheet = test::make_sheet(6);
  const ModelPose pose = *bind_pose(sheet);
  const ConvexCell cells[] = {
      box({0.1, 0.1, -1}, {0.5, 0.5, 1}), box({0.3, 0.3, -1}, {0.7, 0.7, 1}),
      box({0.4, 0.1, -1}, {0.6, 0.9, 1}), box({0.7, 0.3, -1}, {0.8, 0.7, 1})};
  EXPECT_NEAR(test::clipped_area_of_union(sheet, pose, std::span(cells, 1)), 0.16, 1e-6);
  EXPECT_NEAR(test::clipped_area_of_union(sheet, pose, std::span(cells, 2)), 0.28, 1e-6);
  // The third box adds its own 0.16 except 0.1 x 0.4 in the first and 0.2 x 0.4 in the second,
  // which overlap in 0.1 x 0.2.
  EXPECT_NEAR(test::clipped_area_of_union(sheet, pose, std::span(cells, 3)),
              0.28 + 0.16 - 0.04 - 0.08 + 0.02, 1e-6);
  EXPECT_NEAR(test::clipped_area_of_union(sheet, pose, cells), 0.34 + 0.04, 1e-6)
      << "the last one only touches";
}

TEST(ClipOracle, of_a_cell_and_its_complement_is_the_whole_area_in_any_pose) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const Character tube = test::make_tube(9, 11, 3);
    const ModelPose pose = test::random_pose(tube, random);
    const Vec3d normal = random.direction();
    const double offset = normal.dot(test::posed_positions(tube, 0, pose)[random.index(80)]);
    const ConvexCell cells[] = {{{normal, offset}}, {{-normal, -offset}}};
    const double all = whole_area(tube, pose);
    EXPECT_NEAR(test::clipped_area(tube, pose, cells[0]) + test::clipped_area(tube, pose, cells[1]),
                all, 1e-12 * all);
    EXPECT_NEAR(test::clipped_area_of_union(tube, pose, cells), all, 1e-12 * all);
  }
}

TEST(ClipOracle, a_tear_without_width_removes_nothing) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    auto model = TornModel::create(std::make_shared<const Character>(test::make_tube(9, 11, 3)));
    ASSERT_TRUE(model);
    const ModelPose pose = test::random_pose(model->source(), random);
    ASSERT_TRUE(model->tear(pose, test::random_stroke(model->source(), pose, random)));
    EXPECT_NEAR(test::removed_area(*model, pose), 0.0, 1e-12 * whole_area(model->source(), pose));
  }
}

}  // namespace
}  // namespace sunder
