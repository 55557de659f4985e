// A model of fixed capacity: warm operations allocate nothing, and if room runs out nothing
// changes.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include <cmath>
#include <functional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "support/oracles/torn_invariants.h"

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

/// Calls of operator new by a call that must succeed.
std::uint64_t allocations_of(const std::function<bool()>& call) {
  const std::uint64_t before = test::allocation_count();
  EXPECT_TRUE(call());
  return test::allocation_count() - before;
}

using Work = std::function<Result<TearReport>(TornModel&, ChangeRecord*)>;

/// Does an operation, undoes, redoes and undoes it until the memory is warm, and counts what the
/// same calls allocate then.
/// @return whether the operation tore anything without setting a piece free.
bool expect_no_allocation(TornModel& model, const Work& work, bool has_record) {
  ChangeRecord change, undone, redone;
  const auto to = [&](ChangeRecord& record) { return has_record ? &record : nullptr; };
  TearReport report;
  const auto operate = [&] {
    auto result = work(model, to(change));
    if (result) report = std::move(*result);
    return bool(result);
  };
  const auto undo = [&] { return bool(model.undo(to(undone))); };
  const auto redo = [&] { return bool(model.redo(to(redone))); };
  for (int i = 0; i < 2; ++i) {
    if (!operate()) return false;
    if (report.runs == 0) return false;
    EXPECT_TRUE(undo() && redo() && undo());
  }
  const std::uint64_t of_operation = allocations_of(operate);
  if (report.pieces.empty()) {  // whose lists are allocated
    EXPECT_EQ(of_operation, 0u);
  }
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(allocations_of(undo), 0u);
    EXPECT_EQ(allocations_of(redo), 0u);
  }
  EXPECT_EQ(allocations_of(undo), 0u);
  return report.pieces.empty();
}

TEST(Capacity, gaps_bores_undo_and_redo_of_a_warm_model_allocate_nothing) {
  const Character tube = test::make_tube(20, 24, 8);
  std::vector<int> done(4);
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(tube, kRoom);
    const ModelPose pose = test::random_pose(tube, random, 0.4, 1.0);
    const Stroke stroke = test::random_stroke(tube, pose, random, 1.5, 2 + random.index(4));
    const double width = random.uniform(0.02, 0.1);
    Bore bore;
    bore.origin = stroke[0].base;
    bore.direction = stroke[0].tip - stroke[0].base;
    bore.radius = random.uniform(0.05, 0.2);
    bore.depth = 1.5 * bore.direction.norm();
    const std::vector<Work> works = {
        [&](TornModel& of, ChangeRecord* change) { return of.tear(pose, stroke, {}, change); },
        [&](TornModel& of, ChangeRecord* change) {
          return of.tear(pose, stroke, {width, Layers::nearest, 0}, change);
        },
        [&](TornModel& of, ChangeRecord* change) {
          return of.tear(pose, stroke, {width, Layers::all, 0}, change);
        },
        [&](TornModel& of, ChangeRecord* change) { return of.drill(pose, bore, change); }};
    for (std::size_t i = 0; i < works.size(); ++i) {
      SCOPED_TRACE(i);
      for (const bool has_record : {false, true})
        done[i] += expect_no_allocation(model, works[i], has_record) ? 1 : 0;
    }
  }
  EXPECT_THAT(done, testing::Each(testing::Gt(10)));
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

/// Cuts across a tube of which half goes exactly through vertices, and that are bounded and limited
/// in turn: where a cut is simple, faces are crossed in another way.
PlaneCut cut_across(std::uint64_t seed, bool caps, Random& random) {
  PlaneCut cut;
  cut.caps = caps;
  cut.point = {0, random.uniform(1, 2), 0};
  cut.normal = random.direction();
  if (seed % 2 == 1) cut.normal.y() = 0;  // the tube has vertices above one another
  if (seed % 5 == 2) {
    const Vec3d x = cut.normal.unitOrthogonal(), y = cut.normal.normalized().cross(x);
    for (const auto& [u, v] : {std::array{-3.0, -3.0}, {3.0, -3.0}, {3.0, 3.0}, {-3.0, 3.0}})
      cut.bounds.push_back(cut.point + u * x + v * y);
  }
  if (seed % 5 == 3) cut.sections = {cut.point};
  if (seed % 5 == 4) cut.bone = "bone1";
  return cut;
}

/// Cuts and undoes until the memory is warm, and counts what the same calls allocate then.
void expect_warm_cuts(bool caps) {
  const Character tube = test::make_tube(20, 24, 8);
  int divided = 0, capped = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(tube, kRoom);
    const PlaneCut cut = cut_across(seed, caps, random);
    const ModelPose pose = test::random_pose(tube, random, 0.2, 1.0),
                    other = test::random_pose(tube, random, 0.2, 1.0);
    ChangeRecord change;
    for (int i = 0; i < 3; ++i) {  // builds what is built on first use, with enough memory
      ASSERT_TRUE(model.cut(i % 2 == 0 ? pose : other, cut, &change));
      ASSERT_TRUE(model.undo(&change));
    }
    const std::uint64_t before = test::allocation_count();
    const auto report = model.cut(pose, cut, &change);
    EXPECT_EQ(test::allocation_count(), before);
    ASSERT_TRUE(report) << report.error().text();
    const std::uint64_t before_undo = test::allocation_count();
    EXPECT_TRUE(model.undo(&change));
    EXPECT_EQ(test::allocation_count(), before_undo);
    divided += report->pieces.size() > 1 ? 1 : 0;
    capped += report->caps > 1 ? 1 : 0;
  }
  EXPECT_GT(divided, 30);
  EXPECT_EQ(capped > 30, caps);
}

TEST(Capacity, a_warm_cut_allocates_nothing) { expect_warm_cuts(false); }

TEST(Capacity, a_warm_cut_with_caps_allocates_nothing) { expect_warm_cuts(true); }

/// A stroke of a model that was torn in the same way before. @param moves  whether each blade is in
/// another pose than the one before.
void expect_warm_stroke(const TearOptions& options, bool moves) {
  const Character sheet = test::make_sheet(40);
  TornModel model = make_model(sheet, kRoom);
  Random random(1);
  const std::vector<ModelPose> poses = {
      *bind_pose(sheet), moves ? test::random_pose(sheet, random, 0.02, 1.0) : *bind_pose(sheet)};
  const auto blade = [](int i) {
    const double x = 0.1 + 0.01 * i, y = 0.5 + 0.1 * std::sin(0.1 * i);
    return Blade{{x, y, 0.5}, {x, y, -0.5}};
  };
  ChangeRecord change, undone;
  for (int turn = 0; turn < 4; ++turn) {  // the memory is warm in the last one
    auto stroke = TearStroke::create(model, poses[0], blade(0), options);
    ASSERT_TRUE(stroke);
    for (int i = 1; i < 60; ++i) {
      const std::uint64_t before = test::allocation_count();
      const auto report =
          stroke->extend(poses[static_cast<std::size_t>(i % 2)], blade(i), 0, &change);
      // The first calls make the copies to which a failed call would return.
      if (turn == 3 && i > 10) {
        EXPECT_EQ(test::allocation_count(), before) << i;
      }
      ASSERT_TRUE(report);
    }
    const auto whole = stroke->end();
    ASSERT_TRUE(whole);
    EXPECT_GT(options.width > 0 ? whole->area_removed_posed : whole->length_posed, 0);
    ASSERT_TRUE(model.undo(&undone));
  }
}

TEST(Capacity, extending_a_warm_stroke_allocates_nothing_whatever_its_width_and_pose) {
  for (const double width : {0.0, 0.03})
    for (const bool moves : {false, true}) {
      SCOPED_TRACE(testing::Message() << width << (moves ? " moving" : ""));
      expect_warm_stroke({width, Layers::nearest, 0}, moves);
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
  struct Used {
    double bytes, blocks;
  };
  const auto create_with = [&](const TornCapacity& capacity) {
    const std::uint64_t bytes = test::live_bytes(), blocks = test::allocation_count();
    const auto model = TornModel::create(tube, capacity);
    EXPECT_TRUE(model);
    return Used{static_cast<double>(test::live_bytes() - bytes),
                static_cast<double>(test::allocation_count() - blocks)};
  };
  const TornCapacity few{1000, 2000, 4}, many{21000, 42000, 4};
  // A large block that is freed for the first time changes how malloc rounds later ones.
  (void)create_with(many);
  const Used least = create_with(few), of_vertices = create_with(many),
             of_operations = create_with({1000, 2000, 68});
  // What was freed before decides by how much a block is larger than asked for.
  constexpr double kRoundingOfBlock = 32;
  const auto rounding = [&](const Used& used) {
    return kRoundingOfBlock * (used.blocks + least.blocks);
  };
  const double pose = sizeof(Affine3d) * 163.0;
  EXPECT_LT(of_vertices.bytes - least.bytes, 620.0 * 20000 + rounding(of_vertices));
  EXPECT_LT(of_operations.bytes - least.bytes, 64.0 * (2048 + pose) + rounding(of_operations));
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
  // The record holds what was torn.
  const auto history = model.history();
  ASSERT_TRUE(history);
  ASSERT_EQ(history->size(), 8u);
  EXPECT_EQ(std::get<TearOperation>((*history)[0]).stroke.size(), 40u);
  for (std::size_t i = 2; i < 8; ++i)
    EXPECT_EQ(std::get<TearOperation>((*history)[i]).stroke.size(), 3 + 2 * (i - 2));
}

}  // namespace
}  // namespace sunder
