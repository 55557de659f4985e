// Strokes whose calls fail because there is no room, that are cancelled, or that are never ended.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::difference;
using test::make_model;
using test::Random;
using test::state_of;
using testing::IsEmpty;

/// A stroke to be torn blade by blade, and the pose of each blade.
struct MovingStroke {
  TearOptions options;
  StrokeSampling sampling;
  Stroke blades;
  std::vector<ModelPose> poses;
};

/// With a width, walls, both or neither, on one layer or all, in one pose or several; some skip
/// blades.
MovingStroke random_moving_stroke(const Character& source, Random& random) {
  MovingStroke stroke;
  const ModelPose first = test::random_pose(source, random, 0.3, 1.0);
  const double size = test::posed_diagonal(source, first), length = random.uniform(0.1, 0.5);
  stroke.blades = test::random_stroke(source, first, random, length, 3 + random.index(4));
  if (random.index(3) > 0) stroke.options.width = random.uniform(0.002, 0.05) * size;
  if (random.index(3) > 0) stroke.options.wall_depth = random.uniform(0.002, 0.02) * size;
  if (random.index(4) == 0) stroke.options.layers = Layers::all;
  if (random.index(3) == 0) stroke.sampling.minimum_distance = random.uniform(0.0, 0.3) * size;
  const bool moves = random.index(2) == 0;
  for (const Blade& blade : stroke.blades) {
    const bool is_new = moves && !stroke.poses.empty() && random.index(2) == 0;
    stroke.poses.push_back(stroke.poses.empty() ? first
                           : is_new             ? test::random_pose(source, random, 0.1, 1.0)
                                                : stroke.poses.back());
    (void)blade;
  }
  return stroke;
}

Result<TearStroke> begin(TornModel& model, const MovingStroke& stroke) {
  return TearStroke::create(model, stroke.poses[0], stroke.blades[0], stroke.options,
                            stroke.sampling);
}

/// A model with an operation to undo and one to redo, and its state, to which it must return when a
/// stroke is cancelled.
struct Stage {
  TornModel model;
  test::ModelState before;
  std::uint32_t undo_count, redo_count;

  Stage(const Character& character, const std::vector<Operation>& operations,
        const TornCapacity& capacity)
      : model(make_model(character, capacity)) {
    for (const Operation& operation : operations) EXPECT_TRUE(test::play(model, operation));
    if (model.undo_count() > 0) {
      EXPECT_TRUE(model.undo());
    }
    before = state_of(model);
    undo_count = model.undo_count();
    redo_count = model.redo_count();
  }

  void expect_as_before() {
    EXPECT_EQ(difference(state_of(model), before), "");
    EXPECT_EQ(model.undo_count(), undo_count);
    EXPECT_EQ(model.redo_count(), redo_count);
    EXPECT_FALSE(model.is_in_stroke());
    EXPECT_THAT(test::broken_laws(model), IsEmpty());
    EXPECT_THAT(test::broken_surface(model), IsEmpty());
  }

  /// Equals the state before, and every later call has the same result as on `other`, which had no
  /// stroke.
  void expect_as_if_there_was_no_stroke(Stage& other, Random& random) {
    expect_as_before();
    const auto expect_same = [&] { EXPECT_EQ(model.digest(), other.model.digest()); };
    for (std::uint32_t i = 0; i < redo_count; ++i) {
      EXPECT_TRUE(model.redo());
      EXPECT_TRUE(other.model.redo());
      expect_same();
    }
    for (std::uint32_t i = 0; i < undo_count + redo_count; ++i) {
      EXPECT_TRUE(model.undo());
      EXPECT_TRUE(other.model.undo());
      expect_same();
    }
    EXPECT_EQ(model.character(), model.source());
    for (int i = 0; i < 2; ++i) {
      const Operation operation = test::random_operation(other.model, random);
      if (!test::play(model, operation)) continue;  // no room
      EXPECT_TRUE(test::play(other.model, operation));
      expect_same();
    }
  }
};

/// The number of failed calls of the strokes below, so that no test passes without a failure.
struct Failures {
  int extensions = 0, ends = 0, ended = 0, went_on = 0;  ///< `went_on`: ended after a failure.
};

/// Fine enough for strokes that need hundreds of vertices.
Character fine_character(Random& random) {
  if (random.index(2) == 0) return test::make_sheet(8 + random.index(17));
  const std::uint32_t rings = 8 + random.index(9), sides = 10 + random.index(11);
  return test::make_tube(rings, sides, 2 + random.index(4));
}

void run_out_of_room(std::uint64_t seed, Failures& failures) {
  SCOPED_TRACE(seed);
  Random random(seed);
  const Character character = fine_character(random);
  std::vector<Operation> operations;
  {
    const TornModel source = make_model(character);
    for (int i = 0; i < 2; ++i) operations.push_back(test::random_tear(source, random, false));
  }
  const MovingStroke tear = random_moving_stroke(character, random);
  const TornCapacity ample{100000, 100000, 10};
  // Room for the earlier operations, and for 20 to 300 vertices of later ones.
  Stage other(character, operations, ample);
  if (other.model.redo_count() > 0) (void)other.model.redo();
  TornCapacity room{20 + random.index(seed % 2 == 0 ? 60 : 281), 0, 10};
  {
    const TornModel& torn = other.model;
    std::uint32_t appended = 0, triangles = 0;
    for (std::uint32_t m = 0; m < torn.character().meshes.size(); ++m) {
      appended +=
          torn.character().meshes[m].vertex_count() - torn.source().meshes[m].vertex_count();
      triangles +=
          torn.character().meshes[m].triangle_count() - torn.source().meshes[m].triangle_count();
    }
    room.vertices += appended;
    room.triangles = triangles + 500;
  }
  if (other.redo_count > 0) (void)other.model.undo();
  Stage stage(character, operations, room);
  TornModel &model = stage.model, &expected = other.model;

  std::optional<Result<TearStroke>> made = begin(model, tear);
  auto straight = begin(expected, tear);
  ASSERT_TRUE(*made && straight);
  const int extensions_before = failures.extensions;
  TearStroke* const stroke = &made->value();
  for (std::size_t i = 1; i < tear.blades.size(); ++i) {
    const std::uint64_t digest = model.digest();
    const auto report = stroke->extend(tear.poses[i], tear.blades[i]);
    if (report) {
      ASSERT_TRUE(straight->extend(tear.poses[i], tear.blades[i]));
      ASSERT_EQ(model.digest(), expected.digest()) << "blade " << i;
      continue;
    }
    ++failures.extensions;
    EXPECT_EQ(report.error().code(), StatusCode::capacity_exceeded) << report.error().text();
    EXPECT_EQ(model.digest(), digest) << "blade " << i;
  }
  const std::uint64_t digest = model.digest();
  const auto report = stroke->end();
  if (report) {
    ASSERT_TRUE(straight->end());
    ASSERT_EQ(model.digest(), expected.digest());
    ++failures.ended;
    failures.went_on += failures.extensions > extensions_before ? 1 : 0;
    TornModel replayed = make_model(character);
    for (const Operation& operation : *model.history())
      ASSERT_TRUE(apply_operation(replayed, operation));
    EXPECT_EQ(replayed.digest(), model.digest());
    return;
  }
  ++failures.ends;
  EXPECT_EQ(report.error().code(), StatusCode::capacity_exceeded) << report.error().text();
  EXPECT_EQ(model.digest(), digest);
  EXPECT_TRUE(model.is_in_stroke());
  EXPECT_FALSE(model.undo());
  EXPECT_EQ(stroke->end().error().code(), StatusCode::capacity_exceeded);
  EXPECT_EQ(model.digest(), digest);
  if (random.index(2) == 0) {
    EXPECT_TRUE(stroke->cancel());
    EXPECT_FALSE(stroke->end());
    EXPECT_FALSE(stroke->cancel());
    EXPECT_FALSE(stroke->extend(tear.poses[0], tear.blades[0]));
  }
  made.reset();
  ASSERT_TRUE(straight->cancel());
  stage.expect_as_if_there_was_no_stroke(other, random);
}

TEST(UnfinishedStroke, that_runs_out_of_room_is_as_it_was_before_the_call) {
  Failures failures;
  const auto count = static_cast<std::uint64_t>(test::stressed(600, 20));
  for (std::uint64_t seed = 0; seed < count && !testing::Test::HasFailure(); ++seed)
    run_out_of_room(seed, failures);
  EXPECT_GT(failures.extensions, 20);
  EXPECT_GT(failures.ends, 50);
  EXPECT_GT(failures.ended, 50);
  EXPECT_GT(failures.went_on, 3);
}

TEST(UnfinishedStroke, cancelled_or_destroyed_is_undone_bit_for_bit) {
  int torn = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(200, 20)); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Character character = test::random_character(random);
    std::vector<Operation> operations;
    {
      const TornModel source = make_model(character);
      for (int i = 0; i < 2; ++i) operations.push_back(test::random_operation(source, random));
    }
    Stage stage(character, operations, {}), other(character, operations, {});
    const MovingStroke tear = random_moving_stroke(character, random);
    {
      auto stroke = begin(stage.model, tear);
      ASSERT_TRUE(stroke);
      const std::size_t blades = 1 + random.index(static_cast<std::uint32_t>(tear.blades.size()));
      for (std::size_t i = 1; i < blades; ++i)
        ASSERT_TRUE(stroke->extend(tear.poses[i], tear.blades[i]));
      torn += stage.model.digest() != stage.before.digest ? 1 : 0;
      if (seed % 2 == 0) {
        ASSERT_TRUE(stroke->cancel());
      }
    }
    stage.expect_as_if_there_was_no_stroke(other, random);
    if (HasFailure()) return;
  }
  EXPECT_GT(torn, 50);
}

TEST(UnfinishedStroke, of_a_log_changes_nothing) {
  int failed = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(300, 20)); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Character character = test::random_character(random);
    const MovingStroke tear = random_moving_stroke(character, random);
    TearOperation operation{tear.poses[0], tear.blades, {}, tear.options};
    for (std::uint32_t i = 1; i < tear.blades.size(); ++i)
      operation.pose_changes.push_back({i, tear.poses[i]});
    const std::uint32_t room = 20 + random.index(281);
    Stage stage(character, {}, {room, room, 4}), other(character, {}, {room, room, 4});
    std::vector<ChangeRecord> changes(1);
    const auto report = apply_operation(stage.model, operation, &changes);
    if (report) continue;
    ++failed;
    EXPECT_EQ(report.error().code(), StatusCode::capacity_exceeded) << report.error().text();
    EXPECT_EQ(changes.size(), 1u);
    stage.expect_as_if_there_was_no_stroke(other, random);
    if (HasFailure()) return;
  }
  EXPECT_GT(failed, 50);
}

}  // namespace
}  // namespace sunder
