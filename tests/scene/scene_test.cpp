// A scene gives each instance the same results, bit for bit, as calls on that instance alone.

#include <sunder/scene/scene.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "scene/frames.h"
#include "support/machine/allocation_count.h"
#include "support/machine/stress.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

std::shared_ptr<const CharacterAsset> make_asset(Character character, bool is_soft) {
  CharacterAssetOptions options;
  if (is_soft) {
    options.soft.emplace();
    options.soft->decomposition.range = 0.2;
    options.soft->tension = {2.0, {}};
  }
  return value_of(
      CharacterAsset::create(std::make_shared<const Character>(std::move(character)), options));
}

/// A tube that waves.
std::shared_ptr<const CharacterAsset> tube(bool is_soft) {
  return make_asset(test::make_tube(30, 16, 5), is_soft);
}

Scene make_scene(std::uint32_t threads = 1) {
  SceneOptions options;
  options.threads = threads;
  return value_of(Scene::create(options));
}

std::vector<Vec3f> positions_of(const PosedMesh& mesh) {
  return {mesh.positions.begin(), mesh.positions.end()};
}

ModelPose pose_at(const Character& character, double time) {
  Pose local = *local_rest_pose(character);
  ModelPose pose;
  EXPECT_TRUE(sample_clip(character.clips[0], time, local));
  EXPECT_TRUE(compute_model_pose(character.skeleton, local, pose));
  return pose;
}

/// The same instance alone and in a scene, with the same commands.
class Twin {
 public:
  Twin(Scene& scene, const std::shared_ptr<const CharacterAsset>& asset, std::uint64_t seed)
      : scene_(scene),
        random_(seed),
        id_(value_of(scene.spawn(asset))),
        alone_(value_of(CharacterInstance::create(asset))),
        start_(random_.index(64) * kFrame) {
    EXPECT_TRUE(scene_.play(id_, 0, layer(start_, PlayMode::once)));
  }

  /// Submits random commands, to be applied in the frame at `time`.
  void command(double time) {
    const Character& source = *alone_.asset()->character();
    pose_ = pose_at(source, std::min(start_ + time, double{source.clips[0].duration}));
    expected_.clear();
    for (std::uint32_t n = random_.index(3); n > 0; --n) command_once(source);
  }

  void expect_same(double seconds, std::span<const CommandResult> results) {
    std::size_t next = 0;
    for (const CommandResult& result : results) {
      if (!(result.instance == id_)) continue;
      ASSERT_LT(next, expected_.size());
      const auto& [id, report] = expected_[next++];
      EXPECT_EQ(result.command, id);
      ASSERT_EQ(static_cast<bool>(result.status), report.has_value()) << result.status.text();
      if (report) {
        EXPECT_EQ(result.report.faces_crossed, report->faces_crossed);
      }
    }
    EXPECT_EQ(next, expected_.size());
    ASSERT_TRUE(alone_.advance(pose_, seconds));
    ASSERT_TRUE(alone_.draw());
    const PosedMesh found = scene_.mesh(id_, 0), wanted = alone_.mesh(0);
    ASSERT_EQ(found.positions.size(), wanted.positions.size());
    EXPECT_EQ(
        std::memcmp(found.positions.data(), wanted.positions.data(), wanted.positions.size_bytes()),
        0);
    EXPECT_TRUE(std::equal(found.ranges.begin(), found.ranges.end(), wanted.ranges.begin(),
                           wanted.ranges.end()));
  }

 private:
  template <class Call>
  void submit(SceneCommand command, Call call) {
    const CommandId id = value_of(scene_.submit(id_, std::move(command)));
    expected_.emplace_back(id, call());
  }
  static Result<TearReport> report_of(const Status& status) {
    return status ? Result<TearReport>(TearReport()) : Result<TearReport>(status);
  }

  void command_once(const Character& source) {
    switch (random_.index(6)) {
      case 0: return submit(UndoCommand{}, [&] { return report_of(alone_.undo()); });
      case 1: return submit(RedoCommand{}, [&] { return report_of(alone_.redo()); });
      case 2: {
        PlaneCut cut;
        cut.point = Vec3d(0, random_.uniform(0.2, 0.8), 0);
        cut.normal = random_.direction();
        cut.caps = random_.index(2) == 0;
        return submit(cut, [&] { return alone_.cut(pose_, cut); });
      }
      default: {
        const TearCommand of = {test::random_stroke(source, pose_, random_, 0.3, 3), {}};
        return submit(of, [&] { return alone_.tear(pose_, of.stroke, of.options); });
      }
    }
  }

  Scene& scene_;
  test::Random random_;
  InstanceId id_;
  CharacterInstance alone_;
  double start_;
  ModelPose pose_;
  std::vector<std::pair<CommandId, Result<TearReport>>> expected_;
};

TEST(scene, gives_the_bits_of_instances_alone_for_any_number_of_threads) {
  for (const bool is_soft : {false, true}) {
    const auto asset = tube(is_soft);
    for (const std::uint32_t threads : {1u, 2u, 4u})
      for (int seed = 1; seed <= test::stressed(3, 20); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed) + (is_soft ? ", soft" : ", rigid"));
        Scene scene = make_scene(threads);
        scene.set_budget({.settled_points = FrameBudget::kUnlimited});
        std::vector<std::unique_ptr<Twin>> twins;
        for (std::uint64_t i = 0; i < 5; ++i)
          twins.push_back(
              std::make_unique<Twin>(scene, asset, 10 * static_cast<std::uint64_t>(seed) + i));
        for (int frame = 0; frame < 12 && !HasFatalFailure(); ++frame) {
          for (auto& twin : twins) twin->command((frame + 1) * kFrame);
          const Status status = scene.update(kFrame);
          ASSERT_TRUE(status) << status.text();
          for (auto& twin : twins) twin->expect_same(kFrame, scene.results());
        }
      }
  }
}

TEST(scene, names_are_never_used_again) {
  Scene scene = make_scene();
  const auto asset = tube(false);
  const InstanceId first = value_of(scene.spawn(asset));
  const InstanceId second = value_of(scene.spawn(asset));
  EXPECT_TRUE(scene.contains(first));
  ASSERT_TRUE(scene.destroy(first));
  EXPECT_FALSE(scene.contains(first));
  EXPECT_EQ(scene.destroy(first).code(), StatusCode::not_found);
  EXPECT_EQ(scene.play(first, 0).error().code(), StatusCode::not_found);
  EXPECT_EQ(scene.set_visible(first, true).code(), StatusCode::not_found);
  EXPECT_EQ(scene.find(first), nullptr);
  EXPECT_TRUE(scene.mesh(first, 0).positions.empty());
  const InstanceId third = value_of(scene.spawn(asset));
  EXPECT_EQ(third.slot, first.slot);
  EXPECT_NE(third.generation, first.generation);
  EXPECT_FALSE(scene.contains(first));
  EXPECT_TRUE(scene.contains(second));
  EXPECT_EQ(scene.instance_count(), 2u);
  EXPECT_FALSE(scene.contains({}));
}

TEST(scene, what_is_idle_is_not_looked_at) {
  Scene scene = make_scene();
  const auto asset = tube(true);
  std::vector<InstanceId> ids;
  for (int i = 0; i < 20; ++i) ids.push_back(value_of(scene.spawn(asset)));
  ASSERT_TRUE(scene.update(kFrame));
  EXPECT_EQ(scene.stats().drawn, 20u);
  EXPECT_EQ(scene.drawn().size(), 20u);
  ASSERT_TRUE(scene.update(kFrame));
  EXPECT_EQ(scene.stats().idle, 20u);
  EXPECT_EQ(scene.stats().drawn, 0u);
  EXPECT_TRUE(scene.drawn().empty());

  ASSERT_TRUE(scene.play(ids[3], 0));
  ASSERT_TRUE(scene.play(ids[4], 0));
  ASSERT_TRUE(scene.set_visible(ids[4], false));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(scene.update(kFrame));
  EXPECT_EQ(scene.stats().idle, 18u);
  EXPECT_EQ(scene.stats().unseen, 1u);
  EXPECT_EQ(scene.stats().sampled, 1u);
  EXPECT_EQ(scene.stats().drawn, 1u);
  EXPECT_EQ(scene.stats().vertices, asset->character()->meshes[0].vertex_count());
  // Time went on for the one that was not seen.
  ASSERT_TRUE(scene.set_visible(ids[4], true));
  ASSERT_TRUE(scene.update(kFrame));
  EXPECT_EQ(positions_of(scene.mesh(ids[4], 0)), positions_of(scene.mesh(ids[3], 0)));

  const std::uint64_t before = test::allocation_count();
  for (int i = 0; i < 50; ++i) (void)scene.update(kFrame);
  EXPECT_EQ(test::allocation_count(), before);
}

TEST(scene, a_wound_comes_to_rest_and_costs_nothing_then) {
  Scene scene = make_scene();
  const auto asset = tube(true);
  const InstanceId id = value_of(scene.spawn(asset));
  ASSERT_TRUE(scene.update(kFrame));
  test::Random random(4);
  const ModelPose rest = *rest_pose(*asset->character());
  (void)value_of(scene.submit(
      id, TearCommand{test::random_stroke(*asset->character(), rest, random, 0.3, 3), {}}));
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_EQ(scene.results().size(), 1u);
  ASSERT_TRUE(scene.results()[0].status) << scene.results()[0].status.text();
  ASSERT_GT(scene.results()[0].report.runs, 0u);
  int frames = 0;
  while (scene.stats().idle == 0 && ++frames < 2000) ASSERT_TRUE(scene.update(kFrame));
  EXPECT_LT(frames, 2000);
  EXPECT_GT(frames, 5);
}

TEST(scene, those_far_away_take_turns_unless_they_are_torn) {
  SceneOptions options;
  options.threads = 1;
  options.slower_below = {100, 50};
  Scene scene = value_of(Scene::create(options));
  const auto asset = tube(false);
  std::vector<InstanceId> ids;
  for (int i = 0; i < 8; ++i) {
    ids.push_back(value_of(scene.spawn(asset)));
    ASSERT_TRUE(scene.play(ids.back(), 0));
    ASSERT_TRUE(scene.set_screen_height(ids.back(), i < 4 ? 70.0 : 20.0));
  }
  for (int i = 0; i < 8; ++i) ASSERT_TRUE(scene.update(kFrame));  // the first frames draw all
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(scene.update(kFrame));
    EXPECT_EQ(scene.stats().drawn, 2u + 1u);
    EXPECT_EQ(scene.stats().waiting, 5u);
  }
  ASSERT_TRUE(scene.submit(ids[7], UndoCommand{}));  // fails, but somebody works on it
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(scene.update(kFrame));
    EXPECT_TRUE(std::find(scene.drawn().begin(), scene.drawn().end(), ids[7]) !=
                scene.drawn().end());
  }
}

TEST(scene, commands_may_come_from_any_thread_and_fail_alone) {
  Scene scene = make_scene(2);
  const auto asset = tube(false);
  std::vector<InstanceId> ids;
  for (int i = 0; i < 4; ++i) ids.push_back(value_of(scene.spawn(asset)));
  std::vector<std::thread> threads;
  for (const InstanceId id : ids)
    threads.emplace_back([&scene, id] {
      for (int n = 0; n < 50; ++n) (void)scene.submit(id, UndoCommand{});
    });
  for (int i = 0; i < 20; ++i) (void)scene.stats();
  for (std::thread& thread : threads) thread.join();
  ASSERT_TRUE(scene.submit({7, 3}, UndoCommand{}));
  ASSERT_TRUE(scene.submit(ids[1], EndStrokeCommand{}));
  ASSERT_TRUE(scene.destroy(ids[0]));
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_EQ(scene.results().size(), 202u);
  EXPECT_EQ(scene.stats().failed, 202u);
  for (std::size_t i = 0; i < 202; ++i) EXPECT_EQ(scene.results()[i].command, i + 1);
  EXPECT_EQ(scene.results()[200].status.code(), StatusCode::not_found);
  EXPECT_EQ(scene.results()[201].status.code(), StatusCode::invalid_argument);
}

TEST(scene, a_stroke_goes_over_frames_in_the_poses_of_the_clip) {
  const auto asset = tube(true);
  Scene scene = make_scene();
  const InstanceId id = value_of(scene.spawn(asset));
  ASSERT_TRUE(scene.play(id, 0));
  const ModelPose rest = *rest_pose(*asset->character());
  test::Random random(11);
  const Stroke stroke = test::random_stroke(*asset->character(), rest, random, 0.3, 6);
  ASSERT_TRUE(scene.submit(id, BeginStrokeCommand{stroke[0], {}, {}}));
  std::uint32_t crossed = 0;
  for (std::size_t i = 1; i < stroke.size(); ++i) {
    ASSERT_TRUE(
        scene.submit(id, ExtendStrokeCommand{stroke[i], static_cast<double>(i) * kFrame}, {true}));
    ASSERT_TRUE(scene.update(kFrame));
    for (const CommandResult& result : scene.results()) {
      ASSERT_TRUE(result.status) << result.status.text();
      crossed += result.report.faces_crossed;
      if (result.report.faces_crossed > 0) {
        ASSERT_EQ(result.changes.size(), 1u);
        EXPECT_FALSE(result.changes[0].meshes.empty());
      }
    }
  }
  ASSERT_TRUE(scene.submit(id, EndStrokeCommand{}));
  ASSERT_TRUE(scene.update(kFrame));
  EXPECT_EQ(scene.results()[0].report.faces_crossed, crossed);
  EXPECT_GT(crossed, 0u);
  EXPECT_EQ(scene.find(id)->model()->undo_count(), 1u);
}

TEST(scene, a_large_operation_runs_in_the_background) {
  const auto asset = tube(true);
  Scene scene = make_scene();
  const InstanceId swapped = value_of(scene.spawn(asset)), called = value_of(scene.spawn(asset));
  ASSERT_TRUE(scene.update(kFrame));
  PlaneCut cut;
  cut.point = Vec3d(0, 2.2, 0);
  cut.normal = Vec3d(0.1, 1, 0.2);
  cut.caps = true;
  for (const InstanceId id : {swapped, called})
    ASSERT_TRUE(scene.submit(id, cut, {.wants_changes = true, .in_background = id == swapped}));
  ASSERT_TRUE(scene.submit(swapped, UndoCommand{}));  // waits for the cut
  ASSERT_TRUE(scene.submit(swapped, RedoCommand{}));
  std::vector<CommandResult> results;
  for (int i = 0; i < 2000 && results.size() < 4; ++i) {
    ASSERT_TRUE(scene.update(0));
    EXPECT_FALSE(scene.mesh(swapped, 0).positions.empty());
    results.insert(results.end(), scene.results().begin(), scene.results().end());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_EQ(results.size(), 4u);
  for (const CommandResult& result : results) EXPECT_TRUE(result.status) << result.status.text();
  std::sort(results.begin(), results.end(),
            [](const auto& a, const auto& b) { return a.command < b.command; });
  EXPECT_EQ(results[0].report.faces_crossed, results[1].report.faces_crossed);
  EXPECT_EQ(results[0].changes.size(), 1u);
  EXPECT_EQ(scene.find(swapped)->model()->digest(), scene.find(called)->model()->digest());
}

TEST(scene, a_refit_does_not_keep_others_waiting) {
  const auto asset = tube(false);
  Scene scene = make_scene();
  const InstanceId id = value_of(scene.spawn(asset));
  const ModelPose rest = *rest_pose(*asset->character());
  test::Random random(5);
  const auto stroke = [&] {
    return test::random_stroke(*asset->character(), rest, random, 0.3, 3);
  };
  ASSERT_TRUE(scene.submit(id, TearCommand{stroke(), {}}));
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_TRUE(scene.results()[0].status);
  WeightsOperation refit;
  refit.weights.policy = WeightPolicy::refit;
  ASSERT_TRUE(scene.submit(id, refit, {.in_background = true}));
  ASSERT_TRUE(scene.submit(id, TearCommand{stroke(), {}}));
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_EQ(scene.results().size(), 1u);
  EXPECT_EQ(scene.results()[0].command, 3u);
  std::uint32_t refitted = 0;
  for (int i = 0; i < 4000 && refitted == 0; ++i) {
    ASSERT_TRUE(scene.update(kFrame));
    for (const CommandResult& result : scene.results()) {
      ASSERT_TRUE(result.status) << result.status.text();
      refitted = result.report.weights.points;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GT(refitted, 0u);
}

TEST(scene, what_is_destroyed_leaves_no_command_without_a_result) {
  const auto asset = tube(false);
  Scene scene = make_scene();
  const InstanceId id = value_of(scene.spawn(asset));
  ASSERT_TRUE(scene.submit(id, Bore{}, {.in_background = true}));
  ASSERT_TRUE(scene.submit(id, UndoCommand{}));
  ASSERT_TRUE(scene.submit(id, BeginStrokeCommand{}, {.in_background = true}));
  ASSERT_TRUE(scene.update(kFrame));  // starts the bore; the others wait
  ASSERT_TRUE(scene.submit(id, RedoCommand{}));
  const std::size_t done = scene.results().size();
  ASSERT_TRUE(scene.destroy(id));
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_EQ(done + scene.results().size(), 4u);
  for (const CommandResult& result : scene.results())
    EXPECT_EQ(result.status.code(), StatusCode::not_found);
}

TEST(scene, those_far_away_show_a_coarser_level_with_the_same_tears) {
  auto coarse_options = [] {
    CharacterAssetOptions options;
    options.soft.emplace();
    options.soft->decomposition.range = 0.2;
    return options;
  };
  const auto coarse = value_of(CharacterAsset::create(
      std::make_shared<const Character>(test::make_tube(15, 8, 5)), coarse_options()));
  CharacterAssetOptions options = coarse_options();
  options.coarser = coarse;
  options.coarser_below = 100;
  const auto asset = value_of(CharacterAsset::create(
      std::make_shared<const Character>(test::make_tube(30, 16, 5)), options));
  Scene scene = make_scene();
  const InstanceId id = value_of(scene.spawn(asset));
  PlaneCut cut;
  cut.point = Vec3d(0, 2.2, 0);
  cut.normal = Vec3d(0.1, 1, 0.2);
  cut.caps = true;
  ASSERT_TRUE(scene.submit(id, cut));
  ASSERT_TRUE(scene.update(kFrame));
  const std::size_t pieces = scene.results()[0].report.pieces.size();
  ASSERT_GT(pieces, 1u);
  std::uint64_t seen = scene.mesh(id, 0).epoch;
  ASSERT_TRUE(scene.set_screen_height(id, 50));
  for (int i = 0; i < 4000 && scene.shown_level(id) == 0; ++i) {
    ASSERT_TRUE(scene.update(kFrame));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_EQ(scene.shown_level(id), 1u);
  const PosedMesh mesh = scene.mesh(id, 0, seen);
  EXPECT_EQ(mesh.initial_triangles.size(), coarse->triangles(0).size());  // other buffers
  EXPECT_GT(mesh.positions.size(), coarse->character()->meshes[0].positions.size());
  EXPECT_FALSE(mesh.triangle_writes.empty());
  seen = mesh.epoch;
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(scene.update(kFrame));
  EXPECT_TRUE(scene.mesh(id, 0, seen).initial_triangles.empty());
  // Nearby, or torn again, it is the finest level at once.
  ASSERT_TRUE(scene.submit(id, UndoCommand{}));
  ASSERT_TRUE(scene.update(kFrame));
  EXPECT_EQ(scene.shown_level(id), 0u);
  EXPECT_EQ(scene.mesh(id, 0).positions.size(), asset->character()->meshes[0].positions.size());

  CharacterAssetOptions other;
  other.coarser = value_of(
      CharacterAsset::create(std::make_shared<const Character>(test::make_tube(15, 8, 4))));
  EXPECT_EQ(CharacterAsset::create(asset->character(), other).error().code(),
            StatusCode::size_mismatch);
}

TEST(scene, refuses_what_cannot_be) {
  Scene scene = make_scene();
  const auto asset = tube(false);
  EXPECT_EQ(scene.spawn(nullptr).error().code(), StatusCode::empty_input);
  const InstanceId id = value_of(scene.spawn(asset));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(scene.update(kNan).code(), StatusCode::non_finite_value);
  EXPECT_EQ(scene.update(-1).code(), StatusCode::invalid_argument);
  EXPECT_EQ(scene.play(id, 9).error().code(), StatusCode::index_out_of_range);
  EXPECT_EQ(scene.play(id, 0, layer(kNan)).error().code(), StatusCode::non_finite_value);
  EXPECT_EQ(scene.set_screen_height(id, 0).code(), StatusCode::invalid_argument);
  EXPECT_EQ(scene.set_screen_height(id, kNan).code(), StatusCode::invalid_argument);
  ModelPose pose = *rest_pose(*asset->character());
  pose.model_from_bone[1](0, 0) = kNan;
  EXPECT_EQ(scene.set_pose(id, pose).code(), StatusCode::non_finite_value);
  pose.model_from_bone.pop_back();
  EXPECT_EQ(scene.set_pose(id, pose).code(), StatusCode::size_mismatch);
  for (const double height : {kNan, -1.0, std::numeric_limits<double>::infinity()}) {
    SceneOptions options;
    options.slower_below = {100, height};
    EXPECT_EQ(Scene::create(options).error().code(), StatusCode::invalid_argument) << height;
    CharacterAssetOptions of_asset;
    of_asset.coarser_below = height;
    EXPECT_EQ(CharacterAsset::create(asset->character(), of_asset).error().code(),
              StatusCode::invalid_argument)
        << height;
  }
}

}  // namespace
}  // namespace sunder
