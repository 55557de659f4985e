// A capacity that is a limit alone: nothing is allocated in advance, and nothing grows beyond it.
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"

namespace sunder {
namespace {

using test::make_model;
using test::state_of;
using testing::HasSubstr;
using testing::IsEmpty;

struct Growth {
  std::uint32_t vertices = 0, triangles = 0;
};

Growth growth_of(const TornModel& model) {
  const Mesh& mesh = model.character().meshes[0];
  const Mesh& source = model.source().meshes[0];
  return {mesh.vertex_count() - source.vertex_count(),
          static_cast<std::uint32_t>(mesh.triangles.size() - source.triangles.size())};
}

Stroke across(double y) {
  return {test::down_at(0.1, y), test::down_at(0.5, y + 0.05), test::down_at(0.9, y)};
}

TEST(GrowthLimit, allocates_nothing_in_advance) {
  const Character sheet = test::make_sheet(20);
  const TornModel free = make_model(sheet),
                  limited = make_model(sheet, {10000000, 40000000, kNone});
  EXPECT_EQ(limited.memory_bytes().own, free.memory_bytes().own);
  EXPECT_EQ(limited.memory_bytes().reserved, free.memory_bytes().reserved);
}

TEST(GrowthLimit, what_fits_is_as_without_a_limit) {
  const Character sheet = test::make_sheet(20);
  TornModel free = make_model(sheet), limited = make_model(sheet, {1000, 2000, kNone});
  const ModelPose pose = *bind_pose(sheet);
  for (const double y : {0.2, 0.4, 0.6}) {
    ASSERT_TRUE(free.tear(pose, across(y)));
    const auto report = limited.tear(pose, across(y));
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_EQ(limited.digest(), free.digest());
  }
}

TEST(GrowthLimit, an_operation_that_needs_one_vertex_more_changes_nothing) {
  const Character sheet = test::make_sheet(20);
  const ModelPose pose = *bind_pose(sheet);
  TornModel free = make_model(sheet);
  ASSERT_TRUE(free.tear(pose, across(0.2)));
  const Growth once = growth_of(free);
  ASSERT_TRUE(free.tear(pose, across(0.6)));
  const Growth twice = growth_of(free);
  ASSERT_GT(twice.vertices, once.vertices + 10);

  TornModel model = make_model(sheet, {twice.vertices - 1, 10 * twice.triangles, kNone});
  ASSERT_TRUE(model.tear(pose, across(0.2)));
  const auto before = state_of(model);
  const auto report = model.tear(pose, across(0.6));
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code(), StatusCode::capacity_exceeded);
  EXPECT_THAT(std::string(report.error().text()), HasSubstr("no room left for vertices"));
  EXPECT_THAT(test::difference(state_of(model), before), IsEmpty());

  // Undone vertices do not count.
  ASSERT_TRUE(model.undo());
  ASSERT_TRUE(model.tear(pose, across(0.6)));
  ASSERT_TRUE(model.undo());
  ASSERT_TRUE(model.redo());
  EXPECT_EQ(model.undo_count(), 1u);
}

TEST(GrowthLimit, triangles_are_limited_too) {
  const Character sheet = test::make_sheet(20);
  const ModelPose pose = *bind_pose(sheet);
  TornModel free = make_model(sheet);
  ASSERT_TRUE(free.tear(pose, across(0.2)));
  const Growth once = growth_of(free);
  TornModel model = make_model(sheet, {10 * once.vertices, once.triangles - 1, kNone});
  const std::uint64_t untorn = model.digest();
  const auto report = model.tear(pose, across(0.2));
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code(), StatusCode::capacity_exceeded);
  EXPECT_THAT(std::string(report.error().text()), HasSubstr("no room left for triangles"));
  EXPECT_EQ(model.digest(), untorn);
}

TEST(GrowthLimit, any_number_of_operations_is_allowed) {
  const Character sheet = test::make_sheet(4);
  const ModelPose pose = *bind_pose(sheet);
  TornModel model = make_model(sheet, {1000, 4000, kNone});
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(model.cut(pose, {{0, 9, 0}, {0, 1, 0}, {}}));
  EXPECT_TRUE(model.tear(pose, across(0.3)));
}

TEST(GrowthLimit, holds_after_packing) {
  const auto asset = TornAsset::create(std::make_shared<const Character>(test::make_sheet(20)));
  ASSERT_TRUE(asset);
  auto model = TornModel::create(*asset, {100, 400, kNone});
  ASSERT_TRUE(model);
  const ModelPose pose = *bind_pose(model->source());
  ASSERT_TRUE(model->tear(pose, across(0.2)));
  ASSERT_TRUE(model->pack());
  Status last;
  for (int i = 0; i < 10 && last; ++i)
    if (const auto report = model->tear(pose, across(0.3 + 0.05 * i)); !report)
      last = report.error();
  EXPECT_EQ(last.code(), StatusCode::capacity_exceeded);
  EXPECT_LE(growth_of(*model).vertices, 100u);
}

}  // namespace
}  // namespace sunder
