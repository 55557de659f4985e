// A model of fixed capacity: warm operations allocate nothing, and if room runs out nothing
// changes.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/allocation_count.h"
#include "support/make_model.h"
#include "support/model_state.h"
#include "support/rigs.h"
#include "support/torn_invariants.h"

namespace sunder {
namespace {

using test::make_model;
using test::Random;
using testing::IsEmpty;

constexpr TornCapacity kRoom{20000, 20000, 16};

TEST(Capacity, tears_of_a_warm_model_allocate_nothing) {
  const Character tube = test::make_tube(20, 24, 8);
  int torn = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(tube, kRoom);
    const ModelPose pose = test::random_pose(tube, random, 0.4, 1.0),
                    other = test::random_pose(tube, random, 0.4, 1.0);
    const std::uint32_t blades = 2 + random.index(4);
    const Stroke stroke = test::random_stroke(tube, pose, random, 1.5, blades),
                 next = test::random_stroke(tube, other, random, 1.5, 2);
    ASSERT_TRUE(model.tear(pose, stroke));  // builds what is built on first use

    // Another tear in another pose.
    const std::uint64_t before = test::allocation_count();
    const auto report = model.tear(other, next);
    const std::uint64_t allocations = test::allocation_count() - before;
    ASSERT_TRUE(report) << report.error().text();
    if (report->pieces.empty()) {  // whose lists are allocated
      EXPECT_EQ(allocations, 0u);
    }
    torn += report->runs > 0 && report->pieces.empty() ? 1 : 0;

    // With a record that has enough memory.
    ChangeRecord change;
    ASSERT_TRUE(model.undo());
    ASSERT_TRUE(model.tear(other, next, {}, &change));
    ChangeRecord undone;
    ASSERT_TRUE(model.undo(&undone));
    const std::uint64_t before_record = test::allocation_count();
    const auto again = model.tear(other, next, {}, &change);
    if (again->pieces.empty()) {
      EXPECT_EQ(test::allocation_count(), before_record);
    }
  }
  EXPECT_GT(torn, 20);
}

TEST(Capacity, extending_a_stroke_allocates_nothing) {
  const Character sheet = test::make_sheet(40);
  TornModel model = make_model(sheet, kRoom);
  const ModelPose pose = *bind_pose(sheet);
  const auto blade = [](int i) {
    const double x = 0.1 + 0.01 * i, y = 0.5 + 0.1 * std::sin(0.1 * i);
    return Blade{{x, y, 0.5}, {x, y, -0.5}};
  };
  auto stroke = TearStroke::create(model, pose, blade(0));
  ASSERT_TRUE(stroke);
  for (int i = 1; i < 4; ++i) ASSERT_TRUE(stroke->extend(pose, blade(i)));
  for (int i = 4; i < 60; ++i) {
    const std::uint64_t before = test::allocation_count();
    const auto report = stroke->extend(pose, blade(i));
    EXPECT_EQ(test::allocation_count(), before) << i;
    ASSERT_TRUE(report);
    EXPECT_GT(report->length_posed, 0) << i;
  }
}

TEST(Capacity, where_room_runs_out_nothing_changes) {
  int refused = 0, done = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Character character =
        seed % 3 == 0 ? test::make_two_tubes(6, 10) : test::make_tube(10, 12, 4);
    const std::uint32_t room = 4 + random.index(120);
    TornModel model = make_model(character, {room, room, 3});
    for (int i = 0; i < 5; ++i) {
      const ModelPose pose = test::random_pose(character, random, 0.4, 1.0);
      const test::ModelState before = test::state_of(model);
      const std::uint32_t undo_count = model.undo_count();
      Result<TearReport> report = [&]() -> Result<TearReport> {
        switch (random.index(3)) {
          case 0: {
            PlaneCut cut;
            cut.point = {0, random.uniform(0.5, 2.5), 0};
            cut.normal = random.direction();
            cut.caps = random.index(2) == 0;
            return model.cut(pose, cut);
          }
          case 1:
            return model.tear(pose, test::random_stroke(character, pose, random, 1.0, 3),
                              {0.05, Layers::nearest, 0.02});
          default: return model.tear(pose, test::random_stroke(character, pose, random, 1.0, 3));
        }
      }();
      if (report) {
        ++done;
        EXPECT_THAT(test::broken_laws(model), IsEmpty());
        continue;
      }
      ++refused;
      EXPECT_EQ(report.error().code(), StatusCode::capacity_exceeded) << report.error().text();
      EXPECT_THAT(report.error().text(), testing::HasSubstr("no room left for"));
      EXPECT_EQ(test::difference(before, test::state_of(model)), "");
      EXPECT_EQ(model.undo_count(), undo_count);
    }
    while (model.undo_count() > 0) ASSERT_TRUE(model.undo());
    EXPECT_TRUE(model.character().meshes == character.meshes);
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(done, 100);
}

TEST(Capacity, gives_the_same_model_as_one_that_grows) {
  const Character tube = test::make_tube(10, 12, 4);
  TornModel fixed = make_model(tube, kRoom), growing = make_model(tube, {});
  Random random(5);
  for (int i = 0; i < 10; ++i) {
    const ModelPose pose = test::random_pose(tube, random, 0.4, 1.0);
    const Stroke stroke = test::random_stroke(tube, pose, random, 1.0, 3);
    ASSERT_TRUE(fixed.tear(pose, stroke));
    ASSERT_TRUE(growing.tear(pose, stroke));
    EXPECT_EQ(fixed.digest(), growing.digest());
  }
}

TEST(Capacity, undoing_an_operation_makes_room) {
  const Character tube = test::make_tube(10, 12, 4);
  TornModel model = make_model(tube, {2000, 2000, 1});
  Random random(1);
  const ModelPose pose = *bind_pose(tube);
  const Stroke stroke = test::random_stroke(tube, pose, random, 1.0, 3);
  for (int i = 0; i < 20; ++i) {
    const auto report = model.tear(pose, stroke);
    ASSERT_TRUE(report) << report.error().text();
    ASSERT_GT(report->runs, 0u);
    EXPECT_EQ(model.tear(pose, stroke).error().code(), StatusCode::capacity_exceeded);
    ASSERT_TRUE(model.undo());
  }
}

TEST(Capacity, takes_memory_for_what_tears_need) {
  const auto tube = std::make_shared<const Character>(test::make_tube(20, 24, 163));
  const auto bytes_with = [&](const TornCapacity& capacity) {
    const std::uint64_t before = test::live_bytes();
    const auto model = TornModel::create(tube, capacity);
    EXPECT_TRUE(model);
    return static_cast<double>(test::live_bytes() - before);
  };
  const TornCapacity few{1000, 2000, 4};
  const double least = bytes_with(few);
  const double pose = sizeof(Affine3d) * 163.0;
  EXPECT_LT(bytes_with({21000, 42000, 4}) - least, 620.0 * 20000);
  EXPECT_LT(bytes_with({1000, 2000, 68}) - least, 64.0 * (2048 + pose));
}

TEST(Capacity, strokes_of_few_blades_allocate_nothing_after_long_ones) {
  const Character sheet = test::make_sheet(40);
  TornModel model = make_model(sheet, kRoom);
  const ModelPose pose = *bind_pose(sheet);
  const auto stroke_at = [](double y, int blades) {
    Stroke stroke;
    for (int i = 0; i < blades; ++i) stroke.push_back(test::down_at(0.1 + 0.7 * i / blades, y));
    return stroke;
  };
  ASSERT_TRUE(model.tear(pose, stroke_at(0.1, 40)));
  ASSERT_TRUE(model.tear(pose, stroke_at(0.2, 3)));
  for (int i = 0; i < 6; ++i) {
    const Stroke stroke = stroke_at(0.3 + 0.1 * i, 3 + 2 * i);
    const std::uint64_t before = test::allocation_count();
    const auto report = model.tear(pose, stroke);
    EXPECT_EQ(test::allocation_count(), before) << i;
    ASSERT_TRUE(report);
    EXPECT_GT(report->runs, 0u);
  }
  // What is recorded is what was torn.
  const auto history = model.history();
  ASSERT_TRUE(history);
  ASSERT_EQ(history->size(), 8u);
  EXPECT_EQ(std::get<TearOperation>((*history)[0]).stroke.size(), 40u);
  for (std::size_t i = 2; i < 8; ++i)
    EXPECT_EQ(std::get<TearOperation>((*history)[i]).stroke.size(), 3 + 2 * (i - 2));
}

}  // namespace
}  // namespace sunder
