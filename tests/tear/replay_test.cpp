#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "tear/surface/compact.h"

namespace sunder {
namespace {

using test::difference;
using test::down_at;
using test::make_model;
using test::Random;
using test::state_of;

TornModel replay(const Character& source, const std::vector<Operation>& history) {
  TornModel model = make_model(source);
  for (const Operation& operation : history) {
    const auto report = apply_operation(model, operation);
    EXPECT_TRUE(report) << report.error().text();
  }
  return model;
}

/// A stroke on a character that moves between the blades.
void tear_in_motion(TornModel& model, Random& random, bool has_width) {
  TearOperation tear = test::random_tear(model, random, has_width);
  auto stroke =
      TearStroke::create(model, std::get<ModelPose>(tear.pose), tear.stroke[0], tear.options);
  ASSERT_TRUE(stroke) << stroke.error().text();
  for (std::size_t i = 1; i < tear.stroke.size(); ++i) {
    const ModelPose pose = test::random_pose(model.source(), random, 0.2, 1.02);
    ASSERT_TRUE(stroke->extend(pose, tear.stroke[i]));
  }
  ASSERT_TRUE(stroke->end());
}

TEST(Replay, undone_operations_are_what_redo_reapplies) {
  Random random(5);
  TornModel model = make_model(test::random_character(random));
  EXPECT_TRUE(model.undone_operations()->empty());
  while (model.undo_count() < 5)
    ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(model.undo());
  const auto undone = model.undone_operations();
  ASSERT_TRUE(undone);
  ASSERT_EQ(undone->size(), 3u);
  TornModel other = replay(model.source(), *model.history());
  for (const Operation& operation : *undone) {
    ASSERT_TRUE(apply_operation(other, operation));
    ASSERT_TRUE(model.redo());
    EXPECT_EQ(difference(state_of(other), state_of(model)), "");
  }
  EXPECT_TRUE(model.undone_operations()->empty());
}

class RandomReplay : public testing::TestWithParam<int> {};

TEST_P(RandomReplay, of_the_history_reproduces_the_model) {
  Random random(static_cast<std::uint64_t>(GetParam()));
  TornModel model = make_model(test::random_character(random));
  for (int i = 0; i < 6; ++i) {
    const std::uint32_t what = random.index(6);
    if (what == 0 && model.undo_count() > 0)
      ASSERT_TRUE(model.undo());
    else if (what == 1)
      ASSERT_NO_FATAL_FAILURE(tear_in_motion(model, random, random.index(2) == 0));
    else
      ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
    ASSERT_EQ(model.history()->size(), model.undo_count());
    ASSERT_EQ(difference(state_of(replay(model.source(), *model.history())), state_of(model)), "")
        << "operation " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(seeds, RandomReplay, testing::Range(0, 100));

TEST(Replay, history_is_shorter_after_undo_and_longer_after_redo) {
  TornModel model = make_model(test::make_sheet(6));
  EXPECT_TRUE(model.history()->empty());
  const ModelPose pose = *bind_pose(model.source());
  const Stroke first = {down_at(0.2, 0.2), down_at(0.4, 0.3)},
               second = {down_at(0.6, 0.6), down_at(0.8, 0.7)};
  ASSERT_TRUE(model.tear(pose, first));
  const std::uint64_t after_first = model.digest();
  TearOptions options;
  options.width = 0.03;
  ASSERT_TRUE(model.tear(pose, second, options));
  ASSERT_EQ(model.history()->size(), 2u);
  ASSERT_TRUE(model.undo());
  const std::vector<Operation> history = *model.history();
  ASSERT_EQ(history.size(), 1u);
  EXPECT_EQ(std::get<TearOperation>(history[0]).stroke, first);
  EXPECT_EQ(replay(model.source(), history).digest(), after_first);
  ASSERT_TRUE(model.redo());
  ASSERT_EQ(model.history()->size(), 2u);
  EXPECT_EQ(std::get<TearOperation>((*model.history())[1]).stroke, second);
  EXPECT_EQ(std::get<TearOperation>((*model.history())[1]).options, options);
}

TEST(Replay, a_stroke_in_motion_is_one_operation_with_the_poses_it_was_torn_in) {
  TornModel model = make_model(test::make_tube(9, 10, 3));
  Random random(4);
  const TearOperation tear = [&] {
    for (;;)
      if (auto candidate = test::random_tear(model, random, false); candidate.stroke.size() >= 4)
        return candidate;
  }();
  const auto& first_pose = std::get<ModelPose>(tear.pose);
  const ModelPose later_pose = test::random_pose(model.source(), random, 0.1, 1.0);
  auto stroke = TearStroke::create(model, first_pose, tear.stroke[0]);
  ASSERT_TRUE(stroke);
  for (std::size_t i = 1; i < tear.stroke.size(); ++i)
    ASSERT_TRUE(stroke->extend(i < 3 ? first_pose : later_pose, tear.stroke[i]));
  ASSERT_TRUE(stroke->end());
  ASSERT_EQ(model.history()->size(), 1u);
  const auto played = std::get<TearOperation>((*model.history())[0]);
  EXPECT_EQ(played.stroke, tear.stroke);
  std::uint32_t previous = 0;
  for (const auto& change : played.pose_changes) {
    EXPECT_GT(change.blade, previous);
    previous = change.blade;
  }
  ASSERT_FALSE(played.pose_changes.empty());
  EXPECT_EQ(played.pose_changes.back().blade, 3u);
  EXPECT_EQ(difference(state_of(replay(model.source(), *model.history())), state_of(model)), "");
}

TEST(Replay, poses_are_looked_up_by_name) {
  const Character tube = test::make_tube(9, 10, 3);
  const Stroke stroke = {{{0.1, 1.2, 2}, {0.1, 1.2, 0}}, {{0.15, 1.6, 2}, {0.15, 1.6, 0}}};
  BonesPose bones;
  bones.bones.push_back(
      {"bone1", {}, Quatf(Eigen::AngleAxisf(0.3f, Eigen::Vector3f::UnitX())), {}});
  const PoseSpec specs[] = {RestPose{}, BindPose{}, ClipPose{"Bend", 0.7}, ClipPose{0u, 1.1},
                            bones};
  for (const PoseSpec& spec : specs) {
    SCOPED_TRACE(spec.index());
    TearOperation operation;
    operation.pose = spec;
    operation.stroke = stroke;
    TornModel named = make_model(tube), given = make_model(tube);
    std::vector<ChangeRecord> changes;
    const auto report = apply_operation(named, operation, &changes);
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_EQ(report->runs, 1u);
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_EQ(changes[0].point_count, report->points_added);
    const auto pose = make_pose(tube, spec);
    ASSERT_TRUE(pose);
    ASSERT_TRUE(given.tear(*pose, stroke));
    EXPECT_EQ(difference(state_of(named), state_of(given)), "");
    EXPECT_TRUE(
        std::holds_alternative<ModelPose>(std::get<TearOperation>((*named.history())[0]).pose));
  }
}

TEST(Replay, clips_and_bones_that_do_not_exist_are_not_found) {
  TornModel model = make_model(test::make_tube(5, 6, 2));
  const auto before = state_of(model);
  BonesPose nobody;
  nobody.bones.push_back({"nobody", {}, {}, {}});
  TearOperation tear;
  tear.stroke = {{{0.1, 0.2, 2}, {0.1, 0.2, 0}}, {{0.1, 0.6, 2}, {0.1, 0.6, 0}}};
  for (const PoseSpec& spec :
       {PoseSpec(ClipPose{"Jump", 0}), PoseSpec(ClipPose{7u, 0}), PoseSpec(nobody)}) {
    tear.pose = spec;
    EXPECT_EQ(apply_operation(model, tear).error().code(), StatusCode::not_found);
    CutOperation cut;
    cut.pose = spec;
    EXPECT_EQ(apply_operation(model, cut).error().code(), StatusCode::not_found);
    tear.pose = RestPose{};
    tear.pose_changes = {{1, spec}};
    EXPECT_EQ(apply_operation(model, tear).error().code(), StatusCode::not_found);
    tear.pose_changes.clear();
  }
  EXPECT_EQ(difference(state_of(model), before), "");
}

TEST(Replay, undo_and_redo_of_too_many_operations_change_nothing) {
  TornModel model = make_model(test::make_sheet(6));
  const ModelPose pose = *bind_pose(model.source());
  const auto initial = state_of(model);
  ASSERT_TRUE(model.tear(pose, Stroke{down_at(0.2, 0.2), down_at(0.4, 0.3)}));
  ASSERT_TRUE(model.tear(pose, Stroke{down_at(0.6, 0.6), down_at(0.8, 0.7)}));
  const auto torn = state_of(model);
  EXPECT_EQ(apply_operation(model, UndoOperation{3}).error().code(), StatusCode::not_found);
  EXPECT_EQ(difference(state_of(model), torn), "");
  ASSERT_TRUE(apply_operation(model, UndoOperation{2}));
  EXPECT_EQ(difference(state_of(model), initial), "");
  EXPECT_EQ(apply_operation(model, RedoOperation{3}).error().code(), StatusCode::not_found);
  EXPECT_EQ(model.redo_count(), 2u);
  ASSERT_TRUE(apply_operation(model, RedoOperation{2}));
  EXPECT_EQ(difference(state_of(model), torn), "");
}

TEST(Replay, compacting_starts_a_new_history) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(test::random_character(random));
    for (int i = 0; i < 3; ++i)
      ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
    Character expected = model.character();
    const CompactMaps maps = compact(expected);
    const auto compacted = model.compact();
    ASSERT_TRUE(compacted) << compacted.error().text();
    for (std::size_t m = 0; m < maps.meshes.size(); ++m) {
      EXPECT_EQ(compacted->meshes[m].vertex_old_from_new, maps.meshes[m].vertex_old_from_new);
      EXPECT_EQ(compacted->meshes[m].triangle_old_from_new, maps.meshes[m].triangle_old_from_new);
    }
    EXPECT_EQ(model.character(), expected);
    EXPECT_EQ(model.source(), expected);
    EXPECT_EQ(model.undo_count(), 0u);
    EXPECT_EQ(model.redo_count(), 0u);
    EXPECT_TRUE(model.history()->empty());
    EXPECT_EQ(difference(state_of(model), state_of(make_model(expected))), "");
    ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
  }
}

}  // namespace
}  // namespace sunder
