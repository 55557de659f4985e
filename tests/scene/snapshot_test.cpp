// A scene that was saved and restored goes on with the same bits; damaged bytes are refused.

#include <sunder/scene/scene.h>
#include <sunder/skinning/pose.h>

#include <cstring>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "fuzz/sealed_snapshot.h"
#include "scene/frames.h"
#include "support/machine/stress.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

Scene one_thread_scene() {
  SceneOptions options;
  options.threads = 1;
  return value_of(Scene::create(options));
}

using Assets = std::vector<std::shared_ptr<const CharacterAsset>>;

Assets make_assets(bool is_soft) {
  CharacterAssetOptions options;
  if (is_soft) {
    options.soft.emplace();
    options.soft->decomposition.range = 0.2;
    options.soft->tension = {2.0, {}};
  }
  Assets assets;
  for (Character character : {test::make_tube(20, 12, 5), test::make_two_tubes(8, 8)})
    assets.push_back(value_of(
        CharacterAsset::create(std::make_shared<const Character>(std::move(character)), options)));
  return assets;
}

/// Random calls; the same for scenes that are given the same random numbers.
class Play {
 public:
  Play(Scene& scene, const Assets& assets, std::vector<InstanceId> ids, std::uint64_t seed)
      : scene_(scene), assets_(assets), ids_(std::move(ids)), random_(seed) {}

  void frame() {
    if (ids_.empty() || random_.index(6) == 0) spawn();
    for (std::uint32_t n = random_.index(3); n > 0; --n) act(ids_[random_.index(count())]);
    const Status status = scene_.update(kFrame);
    ASSERT_TRUE(status) << status.text();
  }
  [[nodiscard]] const std::vector<InstanceId>& ids() const { return ids_; }

 private:
  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(ids_.size()); }
  void spawn() {
    ids_.push_back(value_of(scene_.spawn(assets_[random_.index(2)])));
    if (!scene_.find(ids_.back())->character().clips.empty()) {
      ASSERT_TRUE(scene_.play(ids_.back(), 0, layer(random_.index(64) * kFrame)));
    }
  }
  void act(InstanceId id) {
    CharacterInstance& instance = *scene_.find(id);
    const Character& source = *instance.asset()->character();
    const ModelPose pose =
        instance.pose().model_from_bone.empty() ? *rest_pose(source) : instance.pose();
    switch (random_.index(9)) {
      case 0: return send(id, UndoCommand{});
      case 1: return send(id, RedoCommand{});
      case 2: ASSERT_TRUE(scene_.set_visible(id, random_.index(3) > 0)); return;
      case 3:
        if (count() < 3) return;
        ASSERT_TRUE(scene_.destroy(id));
        std::erase(ids_, id);
        return;
      case 4: ASSERT_TRUE(scene_.set_pose(id, test::random_pose(source, random_, 0.2))); return;
      case 5: {
        PlaneCut cut;
        cut.point = Vec3d(0, random_.uniform(0.2, 3.0), 0);
        cut.normal = random_.direction();
        cut.caps = random_.index(2) == 0;
        return send(id, cut);
      }
      case 6: {
        WeightsOperation other;
        other.weights.policy = WeightPolicy::pose_exact;
        return send(id, other);
      }
      default: {
        TearCommand tear;
        tear.stroke = test::random_stroke(source, pose, random_, 0.3, 3);
        tear.options.width = random_.index(2) * 0.03;
        return send(id, tear);
      }
    }
  }
  void send(InstanceId id, SceneCommand command) {
    ASSERT_TRUE(scene_.submit(id, std::move(command)));
  }

  Scene& scene_;
  const Assets& assets_;
  std::vector<InstanceId> ids_;
  test::Random random_;
};

template <class T>
void expect_same_bits(std::span<const T> found, std::span<const T> wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  ASSERT_EQ(std::memcmp(found.data(), wanted.data(), wanted.size_bytes()), 0);
}

void expect_same(Scene& a, Scene& b, const std::vector<InstanceId>& ids) {
  ASSERT_EQ(a.instance_count(), b.instance_count());
  for (const InstanceId id : ids) {
    ASSERT_TRUE(b.contains(id));
    const CharacterInstance &of_a = *std::as_const(a).find(id), &of_b = *std::as_const(b).find(id);
    ASSERT_EQ(of_a.model() == nullptr, of_b.model() == nullptr);
    if (of_a.model() != nullptr) {
      ASSERT_EQ(of_a.model()->digest(), of_b.model()->digest());
      ASSERT_EQ(of_a.model()->undo_count(), of_b.model()->undo_count());
      ASSERT_EQ(of_a.model()->redo_count(), of_b.model()->redo_count());
    }
    for (std::uint32_t m = 0; m < of_a.character().meshes.size(); ++m) {
      const PosedMesh wanted = a.mesh(id, m), found = b.mesh(id, m);
      if (found.positions.empty()) continue;  // not visible since
      ASSERT_NO_FATAL_FAILURE(expect_same_bits(found.positions, wanted.positions));
      ASSERT_NO_FATAL_FAILURE(expect_same_bits(found.normals, wanted.normals));
      ASSERT_NO_FATAL_FAILURE(expect_same_bits(found.tangents, wanted.tangents));
    }
  }
}

void save_and_go_on(bool is_soft, std::uint64_t seed) {
  const Assets assets = make_assets(is_soft);
  Scene scene = one_thread_scene();
  Play play(scene, assets, {}, seed);
  for (int i = 0; i < 12; ++i) play.frame();
  ASSERT_TRUE(scene.update(kFrame));
  const std::vector<std::byte> bytes = value_of(scene.save());
  Scene restored = one_thread_scene();
  (void)value_of(restored.spawn(assets[0]));  // goes away
  const Status status = restored.restore(bytes, assets);
  ASSERT_TRUE(status) << status.text();
  EXPECT_EQ(value_of(restored.save()), bytes);
  Play on(scene, assets, play.ids(), seed + 1), again(restored, assets, play.ids(), seed + 1);
  for (int i = 0; i < 10; ++i) {
    SCOPED_TRACE("frame " + std::to_string(i));
    on.frame();
    again.frame();
    ASSERT_EQ(on.ids(), again.ids());
    expect_same(scene, restored, on.ids());
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(snapshot, a_restored_scene_goes_on_with_the_same_bits) {
  for (int seed = 1; seed <= test::stressed(12, 200); ++seed) {
    SCOPED_TRACE(seed);
    for (const bool is_soft : {false, true})
      save_and_go_on(is_soft, static_cast<std::uint64_t>(seed));
    if (HasFatalFailure()) return;
  }
}

/// A scene with a stroke over frames, a cut and a bore on a tube that plays.
Scene torn_scene(const Assets& assets) {
  Scene scene = one_thread_scene();
  const InstanceId id = value_of(scene.spawn(assets[0]));
  EXPECT_TRUE(scene.play(id, 0));
  test::Random random(9);
  const Character& source = *assets[0]->character();
  const Stroke stroke = test::random_stroke(source, *rest_pose(source), random, 0.3, 20);
  EXPECT_TRUE(scene.submit(id, BeginStrokeCommand{stroke[0], {}, {}}));
  for (std::size_t i = 1; i < stroke.size(); ++i) {
    EXPECT_TRUE(scene.submit(id, ExtendStrokeCommand{stroke[i], static_cast<double>(i) * kFrame}));
    EXPECT_TRUE(scene.update(kFrame));
  }
  EXPECT_TRUE(scene.submit(id, EndStrokeCommand{}));
  PlaneCut cut;
  cut.point = Vec3d(0, 2.2, 0);
  cut.normal = Vec3d(0.1, 1, 0);
  cut.caps = true;
  EXPECT_TRUE(scene.submit(id, cut));
  EXPECT_TRUE(scene.update(kFrame));
  return scene;
}

/// Saves a scene, restores it, and compares both.
void expect_restored(Scene& scene, const Assets& assets, const std::vector<InstanceId>& ids) {
  Scene other = one_thread_scene();
  const auto restored = other.restore(value_of(scene.save()), assets);
  ASSERT_TRUE(restored) << restored.text();
  ASSERT_TRUE(scene.update(kFrame) && other.update(kFrame));
  ASSERT_NO_FATAL_FAILURE(expect_same(scene, other, ids));
}

TEST(snapshot, a_snapshot_loaded_on_another_thread_is_exchanged_with_a_scene) {
  const Assets assets = make_assets(true);
  Scene scene = one_thread_scene(), other = one_thread_scene();
  const InstanceId kept = value_of(scene.spawn(assets[0]));
  PlaneCut cut;
  cut.point = Vec3d(0, 1, 0);
  cut.normal = Vec3d(0.1, 1, 0);
  ASSERT_TRUE(scene.submit(kept, cut) && scene.update(kFrame));
  const std::vector<std::byte> bytes = value_of(scene.save());
  std::optional<LoadedSnapshot> loaded;
  std::thread([&] { loaded.emplace(value_of(LoadedSnapshot::create(bytes, assets))); }).join();
  ASSERT_TRUE(scene.update(kFrame));  // goes on meanwhile
  (void)value_of(other.spawn(assets[1]));
  ASSERT_TRUE(other.restore(*loaded));
  EXPECT_EQ(value_of(other.save()), bytes);
  EXPECT_EQ(other.restore(*loaded).code(), StatusCode::invalid_argument);
  EXPECT_EQ(value_of(other.save()), bytes);
  ASSERT_TRUE(other.update(kFrame));
  ASSERT_NO_FATAL_FAILURE(expect_same(scene, other, {kept}));
  loaded.reset();  // with what the scene had before
  ASSERT_TRUE(other.update(kFrame));
}

/// What the first drawing makes is made where the snapshot is loaded.
TEST(snapshot, the_first_frame_of_a_loaded_scene_makes_nothing_new) {
  const Assets assets = make_assets(true);
  Scene scene = torn_scene(assets);
  const InstanceId visible = scene.drawn()[0];
  const InstanceId hidden = value_of(scene.spawn(assets[0]));
  ASSERT_TRUE(scene.set_visible(hidden, false) && scene.update(kFrame));
  LoadedSnapshot loaded = value_of(LoadedSnapshot::create(value_of(scene.save()), assets));
  Scene other = one_thread_scene();
  ASSERT_TRUE(other.restore(loaded));
  const std::size_t before = std::as_const(other).find(visible)->memory_bytes();
  ASSERT_TRUE(other.update(0));  // no pose changes, yet a caller whose buffers are empty must draw
  ASSERT_EQ(other.drawn().size(), 1u);
  EXPECT_EQ(other.drawn()[0], visible);
  EXPECT_EQ(std::as_const(other).find(visible)->memory_bytes(), before);
  EXPECT_FALSE(other.mesh(visible, 0).positions.empty());
  EXPECT_TRUE(other.mesh(hidden, 0).positions.empty());
  ASSERT_TRUE(scene.update(0));
  ASSERT_NO_FATAL_FAILURE(expect_same(scene, other, {visible}));
}

TEST(snapshot, soft_and_rigid_assets_of_a_character_are_told_apart) {
  const Assets assets = {make_assets(false)[0], make_assets(true)[0]};
  Scene scene = one_thread_scene();
  std::vector<InstanceId> ids;
  for (const auto& asset : assets) {
    ids.push_back(value_of(scene.spawn(asset)));
    PlaneCut cut;
    cut.point = Vec3d(0, 1, 0);
    cut.normal = Vec3d(0.1, 1, 0);
    ASSERT_TRUE(scene.submit(ids.back(), cut));
  }
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_NO_FATAL_FAILURE(expect_restored(scene, assets, ids));
  ASSERT_NO_FATAL_FAILURE(expect_restored(scene, {assets[1], assets[0]}, ids));
}

TEST(snapshot, an_undone_tear_across_others_leaves_nothing) {
  CharacterAssetOptions soft;
  soft.soft.emplace();
  const Assets assets = {value_of(
      CharacterAsset::create(std::make_shared<const Character>(test::make_sheet(10)), soft))};
  Scene scene = one_thread_scene();
  const InstanceId id = value_of(scene.spawn(assets[0]));
  const auto tear = [&](const Stroke& stroke) {
    TearCommand command;
    command.stroke = stroke;
    ASSERT_TRUE(scene.submit(id, command) && scene.update(kFrame));
  };
  ASSERT_NO_FATAL_FAILURE(tear({test::down_at(0.1, 0.43), test::down_at(0.9, 0.52)}));
  ASSERT_NO_FATAL_FAILURE(tear({test::down_at(0.43, 0.1), test::down_at(0.52, 0.9)}));
  ASSERT_NO_FATAL_FAILURE(expect_restored(scene, assets, {id}));
  for (int n = 0; n < 2; ++n) {
    ASSERT_TRUE(scene.submit(id, UndoCommand{}) && scene.update(kFrame));
    ASSERT_NO_FATAL_FAILURE(expect_restored(scene, assets, {id}));
  }
  ASSERT_TRUE(scene.submit(id, RedoCommand{}) && scene.submit(id, RedoCommand{}));
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_NO_FATAL_FAILURE(expect_restored(scene, assets, {id}));
}

TEST(snapshot, moments_of_clips_take_the_place_of_poses) {
  const Assets assets = make_assets(false);
  const Scene scene = torn_scene(assets);
  const std::size_t bytes = value_of(scene.save()).size();
  // A stroke of 20 blades in 20 poses of 5 bones: matrices alone would take 10 kB.
  EXPECT_LT(bytes, 3000u);
}

TEST(snapshot, operations_keep_weights_that_are_not_those_of_the_asset) {
  CharacterAssetOptions options;
  options.weights = {WeightPolicy::pose_exact, 0};
  auto asset = CharacterAsset::create(std::make_shared<const Character>(test::make_tube(24, 16, 3)),
                                      options);
  ASSERT_TRUE(asset) << asset.error().text();
  auto scene = Scene::create({}), again = Scene::create({});
  ASSERT_TRUE(scene && again);
  const auto id = scene->spawn(*asset);
  ASSERT_TRUE(id);
  PlaneCut cut;
  cut.point = {0, 0.9, 0};
  cut.normal = {0.1, 1, 0};
  cut.weights = WeightOptions{};
  ASSERT_TRUE(scene->submit(*id, cut));
  ASSERT_TRUE(scene->update(0.01));
  const std::vector<std::shared_ptr<const CharacterAsset>> assets = {*asset};
  ASSERT_TRUE(again->restore(*scene->save(), assets));
  ASSERT_NE(scene->find(*id)->model()->digest(), 0u);
  EXPECT_EQ(again->find(*id)->model()->digest(), scene->find(*id)->model()->digest());
}

TEST(snapshot, damaged_bytes_are_refused_and_change_nothing) {
  const Assets assets = make_assets(false);
  const std::vector<std::byte> good = value_of(torn_scene(assets).save());
  Scene scene = one_thread_scene();
  const InstanceId kept = value_of(scene.spawn(assets[1]));
  ASSERT_TRUE(scene.update(kFrame));
  const std::vector<std::byte> before = value_of(scene.save());
  test::Random random(1);
  int refused = 0;
  for (int i = 0; i < test::stressed(400, 20000); ++i) {
    std::vector<std::byte> bytes = good;
    if (random.index(3) == 0) bytes.resize(random.index(static_cast<std::uint32_t>(good.size())));
    for (std::uint32_t n = random.index(4); n > 0 && !bytes.empty(); --n)
      bytes[random.index(static_cast<std::uint32_t>(bytes.size()))] =
          static_cast<std::byte>(random.index(256));
    const Status status = scene.restore(fuzz::sealed(bytes), assets);
    if (status) {
      (void)scene.update(kFrame);  // it is another scene, whose clips may play at any speed
      ASSERT_TRUE(scene.restore(before, assets));
      continue;
    }
    ++refused;
    ASSERT_FALSE(status.text().empty());
    ASSERT_TRUE(scene.contains(kept));
  }
  EXPECT_GT(refused, 100);
  EXPECT_EQ(value_of(scene.save()), before);

  EXPECT_EQ(scene.restore({}, assets).code(), StatusCode::unsupported_format);
  EXPECT_EQ(scene.restore(good, {assets.data() + 1, 1}).code(), StatusCode::not_found);
  std::vector<std::byte> newer = good;
  newer[4] = std::byte{99};
  EXPECT_EQ(scene.restore(newer, assets).code(), StatusCode::unsupported_format);
  newer = good;
  newer.push_back(std::byte{0});
  EXPECT_EQ(scene.restore(newer, assets).code(), StatusCode::malformed_file);
  EXPECT_EQ(scene.restore(fuzz::sealed(newer), assets).code(), StatusCode::malformed_file);
}

TEST(snapshot, a_stroke_has_to_end_first) {
  const Assets assets = make_assets(false);
  Scene scene = one_thread_scene();
  const InstanceId id = value_of(scene.spawn(assets[0]));
  ASSERT_TRUE(scene.submit(id, BeginStrokeCommand{{{0, 1, 3}, {0, 1, 0}}, {}, {}}));
  ASSERT_TRUE(scene.update(kFrame));
  ASSERT_TRUE(scene.find(id)->is_in_stroke());
  EXPECT_EQ(scene.save().error().code(), StatusCode::invalid_argument);
  ASSERT_TRUE(scene.submit(id, CancelStrokeCommand{}));
  ASSERT_TRUE(scene.update(kFrame));
  EXPECT_TRUE(scene.save());
}

}  // namespace
}  // namespace sunder
