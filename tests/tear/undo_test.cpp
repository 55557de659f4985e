#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <limits>

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
using test::down_at;
using test::make_model;
using test::ModelState;
using test::Random;
using test::state_of;
using testing::IsEmpty;

/// Applies random operations. @return the state before each that can be undone, and the last state.
std::vector<ModelState> play_random(TornModel& model, Random& random, int count) {
  std::vector<ModelState> states = {state_of(model)};
  for (int i = 0; i < count; ++i) {
    const std::uint32_t before = model.undo_count();
    const auto report = test::play(model, test::random_operation(model, random));
    EXPECT_TRUE(report) << report.error().text();
    if (model.undo_count() == before)  // a miss need not be recorded
      EXPECT_EQ(difference(state_of(model), states.back()), "");
    else
      states.push_back(state_of(model));
    EXPECT_EQ(model.undo_count() + 1, states.size());
  }
  return states;
}

void undo_at_random(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  TornModel model = make_model(test::random_character(random));
  const std::vector<ModelState> states = play_random(model, random, 6);
  std::size_t at = states.size() - 1;
  const auto expect_state = [&] {
    EXPECT_EQ(difference(state_of(model), states[at]), "")
        << "after operation " << at << " of " << states.size() - 1;
    EXPECT_EQ(model.undo_count(), at);
    EXPECT_EQ(model.redo_count(), states.size() - 1 - at);
  };
  const auto undo = [&] {
    ASSERT_TRUE(model.undo());
    --at;
    expect_state();
  };
  const auto redo = [&] {
    ASSERT_TRUE(model.redo());
    ++at;
    expect_state();
  };

  while (at > 0) undo();
  EXPECT_EQ(model.character(), model.source());
  EXPECT_EQ(model.point_count(), states[0].point_count);
  while (at + 1 < states.size()) redo();
  for (int i = 0; i < 12; ++i)  // to and fro
    if (const bool back = random.index(2) == 0; back && at > 0)
      undo();
    else if (!back && at + 1 < states.size())
      redo();
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
}

class RandomUndo : public testing::TestWithParam<int> {};

TEST_P(RandomUndo, gives_back_every_state) {
  const int rounds = test::stressed(1, 50);
  for (int round = 0; round < rounds && !HasFailure(); ++round)
    undo_at_random(static_cast<std::uint64_t>(100 * round + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(seeds, RandomUndo, testing::Range(0, 100));

TEST(Undo, of_nothing_is_not_found) {
  TornModel model = make_model(test::make_sheet(3));
  const ModelState before = state_of(model);
  EXPECT_EQ(model.undo().code(), StatusCode::not_found);
  EXPECT_EQ(model.redo().code(), StatusCode::not_found);
  EXPECT_EQ(model.undo_count(), 0u);
  EXPECT_EQ(model.redo_count(), 0u);
  EXPECT_EQ(difference(state_of(model), before), "");
}

TEST(Undo, a_new_operation_clears_the_redo_stack) {
  TornModel model = make_model(test::make_sheet(6));
  const ModelPose pose = *bind_pose(model.source());
  ASSERT_TRUE(model.tear(pose, Stroke{down_at(0.2, 0.2), down_at(0.4, 0.3)}));
  ASSERT_TRUE(model.tear(pose, Stroke{down_at(0.6, 0.6), down_at(0.8, 0.7)}));
  ASSERT_TRUE(model.undo());
  EXPECT_EQ(model.redo_count(), 1u);
  ASSERT_TRUE(model.tear(pose, Stroke{down_at(0.6, 0.2), down_at(0.8, 0.3)}));
  EXPECT_EQ(model.redo_count(), 0u);
  EXPECT_EQ(model.undo_count(), 2u);
  EXPECT_EQ(model.redo().code(), StatusCode::not_found);
}

TEST(Undo, operations_after_an_undo_do_not_depend_on_it) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(test::random_character(random)),
              straight = make_model(model.source());
    const Operation kept = test::random_operation(model, random),
                    undone = test::random_operation(model, random),
                    last = test::random_operation(model, random);
    ASSERT_TRUE(test::play(model, kept));
    const std::uint32_t before = model.undo_count();
    ASSERT_TRUE(test::play(model, undone));
    if (model.undo_count() > before) {
      ASSERT_TRUE(model.undo());
    }
    ASSERT_TRUE(test::play(model, last));
    ASSERT_TRUE(test::play(straight, kept));
    ASSERT_TRUE(test::play(straight, last));
    EXPECT_EQ(difference(state_of(model), state_of(straight)), "");
  }
}

TEST(Undo, an_operation_that_fails_changes_nothing) {
  TornModel model = make_model(test::make_sheet(6));
  const ModelPose pose = *bind_pose(model.source());
  const Stroke stroke = {down_at(0.2, 0.2), down_at(0.4, 0.3)};
  ASSERT_TRUE(model.tear(pose, stroke));
  ASSERT_TRUE(model.tear(pose, Stroke{down_at(0.6, 0.6), down_at(0.8, 0.7)}));
  ASSERT_TRUE(model.undo());
  const ModelState before = state_of(model);
  const auto expect_refused = [&](const Result<TearReport>& report, StatusCode code) {
    EXPECT_EQ(report.error().code(), code) << report.error().text();
    EXPECT_EQ(difference(state_of(model), before), "");
    EXPECT_EQ(model.undo_count(), 1u);
    EXPECT_EQ(model.redo_count(), 1u);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  TearOptions options;
  options.width = -1;
  expect_refused(model.tear(pose, stroke, options), StatusCode::invalid_argument);
  options.width = nan;
  EXPECT_FALSE(model.tear(pose, stroke, options));
  options = {};
  options.wall_depth = -0.1;
  expect_refused(model.tear(pose, stroke, options), StatusCode::invalid_argument);
  expect_refused(model.tear(pose, Stroke{stroke[0]}), StatusCode::invalid_argument);
  expect_refused(model.tear(ModelPose{}, stroke), StatusCode::size_mismatch);

  PlaneCut cut;
  expect_refused(model.cut(ModelPose{}, cut), StatusCode::size_mismatch);
  cut.normal.setZero();
  expect_refused(model.cut(pose, cut), StatusCode::invalid_argument);
  cut = {};
  cut.point.x() = nan;
  expect_refused(model.cut(pose, cut), StatusCode::non_finite_value);

  Bore bore;
  bore.radius = bore.depth = 0.1;
  expect_refused(model.drill(ModelPose{}, bore), StatusCode::size_mismatch);
  bore.radius = 0;
  expect_refused(model.drill(pose, bore), StatusCode::invalid_argument);
  bore.radius = 0.1;
  bore.depth = 0;
  expect_refused(model.drill(pose, bore), StatusCode::invalid_argument);
  bore.depth = 0.1;
  bore.direction.setZero();
  expect_refused(model.drill(pose, bore), StatusCode::invalid_argument);
}

TEST(Undo, an_operation_does_not_get_what_redo_kept_of_another_one) {
  TornModel model = test::make_model(test::make_sheet(6));
  const ModelPose pose = *bind_pose(model.source());
  const auto tear_at = [&](double x) {
    ASSERT_TRUE(model.tear(pose, Stroke{down_at(x, 0.21), down_at(x, 0.63)}));
  };
  tear_at(0.2);
  const std::uint32_t vertices = model.character().meshes[0].vertex_count();
  for (const bool redoes : {true, false}) {
    ASSERT_TRUE(model.undo());
    if (redoes) {
      ASSERT_TRUE(model.redo());
    }
  }
  tear_at(0.7);  // the entry of the first tear is free now, and the next one gets it
  ASSERT_TRUE(model.undo());
  tear_at(0.2 + 1.0 / 6);
  ASSERT_EQ(model.character().meshes[0].vertex_count(), vertices) << "not the same shape";
  const ModelState torn = state_of(model);
  ASSERT_TRUE(model.undo());
  ASSERT_EQ(model.character(), model.source());
  ASSERT_TRUE(model.redo());
  EXPECT_EQ(difference(state_of(model), torn), "");
}

}  // namespace
}  // namespace sunder
