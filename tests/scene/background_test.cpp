// Operations in the background: what they leave, when they take effect, and what does not wait.

#include <sunder/scene/scene.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <functional>

#include <gtest/gtest.h>

#include "scene/frames.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

std::shared_ptr<const CharacterAsset> soft_tube() {
  CharacterAssetOptions options;
  options.soft.emplace();
  options.soft->decomposition.range = 0.2;
  options.soft->tension = {2.0, {}};
  return value_of(CharacterAsset::create(
      std::make_shared<const Character>(test::make_tube(30, 16, 5)), options));
}

/// A job system that runs nothing before it is told to.
class HeldBackground {
 public:
  [[nodiscard]] BackgroundHook hook() {
    const auto run = [](void* of, void (*task)(void*), void* data) {
      static_cast<HeldBackground*>(of)->tasks_.push_back([task, data] { task(data); });
    };
    return {run, this};
  }
  void run_all() {
    for (; !tasks_.empty(); tasks_.pop_front()) tasks_.front()();
  }
  ~HeldBackground() { run_all(); }

 private:
  std::deque<std::function<void()>> tasks_;
};

Scene make_scene(const BackgroundHook& hook, std::uint32_t updates = 0, std::uint32_t threads = 1) {
  SceneOptions options;
  options.threads = threads;
  options.background = hook;
  options.background_updates = updates;
  return value_of(Scene::create(options));
}

InstanceId spawn(Scene& scene, const std::shared_ptr<const CharacterAsset>& asset) {
  const InstanceId id = value_of(scene.spawn(asset));
  EXPECT_TRUE(scene.play(id, 0));
  return id;
}

PlaneCut capped_cut(double height) {
  PlaneCut cut;
  cut.point = Vec3d(0, height, 0);
  cut.normal = Vec3d(0.1, 1, 0.2);
  cut.caps = true;
  return cut;
}

void expect_same(Scene& a, InstanceId of_a, Scene& b, InstanceId of_b) {
  const auto &one = *std::as_const(a).find(of_a), &other = *std::as_const(b).find(of_b);
  ASSERT_EQ(one.model()->digest(), other.model()->digest());
  const PosedMesh wanted = a.mesh(of_a, 0), found = b.mesh(of_b, 0);
  ASSERT_EQ(wanted.positions.size(), found.positions.size());
  ASSERT_FALSE(wanted.positions.empty());
  ASSERT_EQ(
      std::memcmp(wanted.positions.data(), found.positions.data(), wanted.positions.size_bytes()),
      0);
  ASSERT_EQ(std::memcmp(wanted.normals.data(), found.normals.data(), wanted.normals.size_bytes()),
            0);
  ASSERT_TRUE(std::ranges::equal(wanted.ranges, found.ranges));
}

TEST(background, a_swap_leaves_what_a_call_in_its_frame_leaves) {
  constexpr std::uint32_t kUpdates = 4;
  const auto asset = soft_tube();
  Scene swapped = make_scene({}, kUpdates);
  Scene called = make_scene({});
  const InstanceId in_swapped = spawn(swapped, asset), in_called = spawn(called, asset);
  for (const auto& [scene, id] : {std::pair(&swapped, in_swapped), std::pair(&called, in_called)}) {
    ASSERT_TRUE(scene->submit(id, capped_cut(1.0)));
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(scene->update(kFrame));
    ASSERT_TRUE(scene->find(id)->particles()->is_settled());
  }
  ASSERT_NO_FATAL_FAILURE(expect_same(swapped, in_swapped, called, in_called));
  ASSERT_TRUE(swapped.submit(in_swapped, capped_cut(2.2), {.in_background = true}));
  Operation operation;
  for (std::uint32_t i = 0; i <= kUpdates; ++i) {
    if (i == kUpdates) {
      ASSERT_TRUE(called.find(in_called)->apply(operation));
    }
    ASSERT_TRUE(swapped.update(kFrame));
    ASSERT_TRUE(called.update(kFrame));
    if (i == 0) operation = CutOperation{called.find(in_called)->pose(), capped_cut(2.2)};
    ASSERT_EQ(swapped.results().size(), i == kUpdates ? 1u : 0u);
  }
  ASSERT_TRUE(swapped.results()[0].status) << swapped.results()[0].status.text();
  EXPECT_GT(swapped.results()[0].report.faces_crossed, 0u);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    ASSERT_NO_FATAL_FAILURE(expect_same(swapped, in_swapped, called, in_called));
    if (i == 20) {
      ASSERT_TRUE(swapped.submit(in_swapped, UndoCommand{}));
      ASSERT_TRUE(called.submit(in_called, UndoCommand{}));
    }
    ASSERT_TRUE(swapped.update(kFrame));
    ASSERT_TRUE(called.update(kFrame));
  }
}

TEST(background, a_detached_piece_is_the_one_of_a_call_in_its_frame) {
  constexpr std::uint32_t kUpdates = 4;
  const PieceNear place = {Vec3d(0, 6, 0), {}};
  for (const PieceMotion motion : {PieceMotion::frozen, PieceMotion::animated, PieceMotion::none}) {
    SCOPED_TRACE(static_cast<int>(motion));
    DetachOptions options;
    options.motion = motion;
    const auto asset = soft_tube();
    Scene swapped = make_scene({}, kUpdates);
    Scene called = make_scene({});
    const InstanceId in_swapped = spawn(swapped, asset), in_called = spawn(called, asset);
    for (const auto& [scene, id] :
         {std::pair(&swapped, in_swapped), std::pair(&called, in_called)}) {
      ASSERT_TRUE(scene->submit(id, capped_cut(3.0)));
      for (int i = 0; i < 200; ++i) ASSERT_TRUE(scene->update(kFrame));
      ASSERT_TRUE(scene->find(id)->particles()->is_settled());
    }
    ASSERT_TRUE(swapped.submit(in_swapped, DetachCommand{place, options}, {.in_background = true}));
    ModelPose pose;
    DetachedPiece expected;
    PieceTissue tissue;
    for (std::uint32_t i = 0; i <= kUpdates; ++i) {
      if (i == kUpdates)
        expected = value_of(called.find(in_called)->detach(pose, place, options, nullptr, &tissue));
      ASSERT_TRUE(swapped.update(kFrame));
      ASSERT_TRUE(called.update(kFrame));
      if (i == 0) pose = called.find(in_called)->pose();
      ASSERT_EQ(swapped.results().size(), i == kUpdates ? 1u : 0u);
    }
    const CommandResult result = swapped.results()[0];
    ASSERT_TRUE(result.status) << result.status.text();
    ASSERT_NE(result.piece, nullptr);
    ASSERT_EQ(result.report.pieces.size(), 1u);
    EXPECT_EQ(result.report.pieces[0].triangle_count, expected.report.pieces[0].triangle_count);
    EXPECT_EQ(result.piece->model_from_piece.matrix(), expected.model_from_piece.matrix());
    EXPECT_EQ(result.piece->inertia_piece, expected.inertia_piece);
    ASSERT_NE(result.tissue, nullptr);
    EXPECT_EQ(result.piece->points, expected.points);
    EXPECT_EQ(result.tissue->influences, tissue.influences);
    ASSERT_EQ(result.tissue->particles.size(), tissue.particles.size());
    for (std::size_t i = 0; i < tissue.particles.size(); ++i)
      ASSERT_EQ(result.tissue->particles[i].displacement, tissue.particles[i].displacement) << i;
    ASSERT_EQ(result.piece->character == nullptr, motion == PieceMotion::none);
    ASSERT_EQ(result.asset == nullptr, motion == PieceMotion::none);
    if (motion != PieceMotion::none) {
      EXPECT_EQ(*result.piece->character, *expected.character);
      EXPECT_EQ(result.asset->character(), result.piece->character);
      EXPECT_TRUE(result.asset->options().soft.has_value());
      const InstanceId piece = value_of(swapped.spawn(result.asset));
      EXPECT_TRUE(swapped.find(piece)->inherit_motion(*result.piece, *result.tissue));
    }
    for (int i = 0; i < 30; ++i) {
      SCOPED_TRACE(i);
      ASSERT_NO_FATAL_FAILURE(expect_same(swapped, in_swapped, called, in_called));
      if (i == 15) {
        ASSERT_TRUE(swapped.submit(in_swapped, UndoCommand{}));
        ASSERT_TRUE(called.submit(in_called, UndoCommand{}));
      }
      ASSERT_TRUE(swapped.update(kFrame));
      ASSERT_TRUE(called.update(kFrame));
    }
  }
}

TEST(background, a_piece_that_does_not_exist_is_a_failure) {
  Scene scene = make_scene({}, 2);
  const InstanceId id = spawn(scene, soft_tube());
  ASSERT_TRUE(
      scene.submit(id, DetachCommand{PieceNear{Vec3d::Zero(), {}}, {}}, {.in_background = true}));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(scene.update(kFrame));
  ASSERT_EQ(scene.results().size(), 1u);  // it is all that is left of the model
  EXPECT_EQ(scene.results()[0].status.code(), StatusCode::invalid_argument);
  EXPECT_EQ(scene.results()[0].piece, nullptr);
  EXPECT_EQ(scene.results()[0].asset, nullptr);
  EXPECT_EQ(scene.find(id)->model()->undo_count(), 0u);
}

TEST(background, is_advised_for_commands_that_change_much_in_a_frame) {
  const auto asset = value_of(CharacterAsset::create(
      std::make_shared<const Character>(test::make_tube(120, 150, 5)), CharacterAssetOptions{}));
  const DetachCommand end = {PieceNear{Vec3d(0, 6, 0), {}}, {}};
  struct Case {
    const char* name;
    SceneCommand command;
    CommandOptions options;
    bool is_advised;
  };
  const Case cases[] = {
      {"a cut with caps", capped_cut(2.2), {}, true},
      {"the same in the background", capped_cut(1.7), {.in_background = true}, false},
      {"a bore that misses", Bore{Vec3d(50, 0, 0), Vec3d(0, 0, 1), 0.1, 1.0, {}}, {}, false},
      {"a small bore", Bore{Vec3d(0, 3.1, 5), Vec3d(0, 0, -1), 0.05, 5.0, {}}, {}, false},
      {"a piece", end, {}, true},
      {"undo of it", UndoCommand{}, {}, false}};
  Scene scene = make_scene({}, 1);
  const InstanceId id = spawn(scene, asset);
  for (const Case& of : cases) {
    SCOPED_TRACE(of.name);
    ASSERT_TRUE(scene.submit(id, of.command, of.options));
    do {
      ASSERT_TRUE(scene.update(kFrame));
    } while (scene.results().empty());
    const CommandResult& result = scene.results()[0];
    ASSERT_TRUE(result.status) << result.status.text();
    EXPECT_EQ(result.advises_background, of.is_advised);
  }
}

TEST(background, strokes_do_not_wait) {
  HeldBackground background;
  const auto asset = soft_tube();
  Scene scene = make_scene(background.hook());
  const InstanceId id = spawn(scene, asset);
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_TRUE(scene.submit(id, capped_cut(2.2), {.in_background = true}));
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_EQ(scene.stats().in_background, 1u);

  const Character& source = *asset->character();
  test::Random random(11);
  const Stroke stroke = test::random_stroke(source, scene.find(id)->pose(), random, 0.3, 6);
  ASSERT_TRUE(scene.submit(id, BeginStrokeCommand{stroke[0], {}, {}}));
  for (std::size_t i = 1; i < stroke.size(); ++i) {
    ASSERT_TRUE(scene.submit(id, ExtendStrokeCommand{stroke[i], static_cast<double>(i) * kFrame}));
    if (i == 3) background.run_all();  // the cut is done, of a model that is no more
    ASSERT_TRUE(scene.update(kFrame));
    ASSERT_FALSE(scene.results().empty());
    for (const CommandResult& result : scene.results())
      EXPECT_TRUE(result.status) << result.status.text();
  }
  ASSERT_TRUE(scene.submit(id, EndStrokeCommand{}));
  ASSERT_TRUE(scene.submit(id, UndoCommand{}));  // waits
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_EQ(scene.results().size(), 1u);
  EXPECT_EQ(scene.find(id)->model()->undo_count(), 1u);

  std::vector<CommandResult> results;
  for (int i = 0; i < 4 && results.size() < 2; ++i) {
    background.run_all();
    ASSERT_TRUE(scene.update(kFrame));
    results.insert(results.end(), scene.results().begin(), scene.results().end());
  }
  ASSERT_EQ(results.size(), 2u);
  for (const CommandResult& result : results) EXPECT_TRUE(result.status) << result.status.text();
  EXPECT_GT(results[0].report.faces_crossed, 0u);
  EXPECT_EQ(scene.find(id)->model()->undo_count(), 1u);  // the cut was undone, not the stroke
}

/// Calls of all kinds on a scene; the same for the same seed.
void play_randomly(Scene& scene, InstanceId id, std::uint64_t seed,
                   const std::function<void()>& after_update) {
  test::Random random(seed);
  const Character& source = *scene.find(id)->asset()->character();
  for (int i = 0; i < 60; ++i) {
    const ModelPose& pose = scene.find(id)->pose();
    switch (random.index(6)) {
      case 0:
        (void)scene.submit(id, capped_cut(random.uniform(0.3, 2.7)), {.in_background = true});
        break;
      case 1: (void)scene.submit(id, UndoCommand{}); break;
      case 2: {
        if (pose.model_from_bone.empty()) break;
        const Stroke stroke = test::random_stroke(source, pose, random, 0.3, 3);
        (void)scene.submit(id, BeginStrokeCommand{stroke[0], {}, {}});
        (void)scene.submit(id, ExtendStrokeCommand{stroke[1], kFrame});
        (void)scene.submit(id, EndStrokeCommand{});
        break;
      }
      case 3: {
        WeightsOperation refit;
        refit.weights.policy = WeightPolicy::refit;
        (void)scene.submit(id, refit, {.in_background = true});
        break;
      }
      default: break;
    }
    ASSERT_TRUE(scene.update(kFrame));
    after_update();
  }
}

TEST(background, results_do_not_depend_on_its_speed_after_a_fixed_number_of_updates) {
  const auto asset = soft_tube();
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    HeldBackground never, at_once;
    Scene one = make_scene(never.hook(), 3), other = make_scene(at_once.hook(), 3),
          third = make_scene({}, 3, 2);
    const InstanceId in_one = spawn(one, asset), in_other = spawn(other, asset),
                     in_third = spawn(third, asset);
    ASSERT_NO_FATAL_FAILURE(play_randomly(one, in_one, seed, [] {}));
    ASSERT_NO_FATAL_FAILURE(play_randomly(other, in_other, seed, [&] { at_once.run_all(); }));
    ASSERT_NO_FATAL_FAILURE(play_randomly(third, in_third, seed, [] {}));
    if (one.find(in_one)->model() == nullptr) continue;
    ASSERT_NO_FATAL_FAILURE(expect_same(one, in_one, other, in_other));
    ASSERT_NO_FATAL_FAILURE(expect_same(one, in_one, third, in_third));
    never.run_all();
  }
}

TEST(background, a_failure_lets_tissue_settle_again) {
  HeldBackground background;
  Scene scene = make_scene(background.hook());
  const InstanceId id = spawn(scene, soft_tube());
  ASSERT_TRUE(scene.submit(id, capped_cut(1.5)));
  ASSERT_TRUE(scene.update(kFrame));
  PlaneCut faulty;
  faulty.normal = Vec3d::Zero();
  ASSERT_TRUE(scene.submit(id, faulty, {.in_background = true}));
  ASSERT_TRUE(scene.update(kFrame));
  background.run_all();
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_EQ(scene.results().size(), 1u);
  EXPECT_FALSE(scene.results()[0].status);
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(scene.update(kFrame));
  EXPECT_TRUE(scene.find(id)->particles()->is_settled());
}

std::shared_ptr<const CharacterAsset> soft_tube(std::uint32_t rings, std::uint32_t sides,
                                                std::shared_ptr<const CharacterAsset> coarser) {
  CharacterAssetOptions options;
  options.soft.emplace();
  options.soft->decomposition.range = 0.2;
  options.coarser_below = coarser ? 100 : 0;
  options.coarser = std::move(coarser);
  return value_of(CharacterAsset::create(
      std::make_shared<const Character>(test::make_tube(rings, sides, 5)), options));
}

Vec3d mean_of(std::span<const Vec3f> places) {
  Vec3d sum = Vec3d::Zero();
  for (const Vec3f& place : places) sum += place.cast<double>();
  return sum / static_cast<double>(places.size());
}

TEST(background, a_coarser_level_starts_from_the_motion_of_the_finest) {
  const auto coarse = soft_tube(16, 10, nullptr), fine = soft_tube(30, 16, coarse);
  HeldBackground background;
  Scene scene = make_scene(background.hook());
  const InstanceId moving = value_of(scene.spawn(fine)), still = value_of(scene.spawn(coarse));
  ASSERT_TRUE(scene.find(moving)->prepare_to_tear());
  ASSERT_TRUE(scene.update(kFrame));
  SoftBody& body = *scene.find(moving)->body();
  for (std::uint32_t p = 0; p < body.particle_count(); ++p)
    ASSERT_TRUE(body.add_impulse(p, {0.05, 0, 0.02}));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(scene.update(kFrame));
  Vec3d wanted = Vec3d::Zero();
  const auto points = scene.find(moving)->particles()->vertex_points(0);
  for (const std::uint32_t point : points)
    wanted += body.point_displacement(point) / static_cast<double>(points.size());
  ASSERT_GT(wanted.norm(), 1e-4);

  ASSERT_TRUE(scene.set_screen_height(moving, 10));
  for (int i = 0; i < 4 && scene.shown_level(moving) == 0; ++i) {
    ASSERT_TRUE(scene.update(0));
    background.run_all();
  }
  ASSERT_EQ(scene.shown_level(moving), 1u);
  const Vec3d moved =
      mean_of(scene.mesh(moving, 0).positions) - mean_of(scene.mesh(still, 0).positions);
  EXPECT_LT((moved - wanted).norm(), 0.3 * wanted.norm());
}

}  // namespace
}  // namespace sunder
