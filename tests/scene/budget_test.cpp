// Optional work is spread over updates by a budget, with the same bits wherever it is replayed.

#include <sunder/scene/scene.h>
#include <sunder/skinning/pose.h>

#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "scene/frames.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

std::shared_ptr<const CharacterAsset> soft_ball() {
  auto character = std::make_shared<Character>(test::make_bumpy_ball(3000));
  test::rig_along(*character, 6);
  CharacterAssetOptions options;
  options.soft.emplace();
  options.soft->tension = {2.0, {}};
  auto asset = CharacterAsset::create(std::move(character), options);
  EXPECT_TRUE(asset) << asset.error().text();
  return *asset;
}

/// Instances, each torn all around.
class TornScene {
 public:
  TornScene(const std::shared_ptr<const CharacterAsset>& asset, std::uint32_t threads,
            int count = 4)
      : scene_(make(threads)) {
    PlaneCut cut;
    Eigen::AlignedBox3d box;
    for (const Vec3f& at : asset->character()->meshes[0].positions) box.extend(at.cast<double>());
    cut.point = box.center();
    cut.normal = Vec3d(0.1, 1, 0.2);
    for (int i = 0; i < count; ++i) {
      ids.push_back(*scene_.spawn(asset));
      EXPECT_TRUE(scene_.submit(ids.back(), cut));
    }
  }
  void update(const FrameBudget& budget) {
    scene_.set_budget(budget);
    ASSERT_TRUE(scene_.update(kFrame));
  }
  [[nodiscard]] Scene& scene() { return scene_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  std::vector<InstanceId> ids;

 private:
  static Scene make(std::uint32_t threads) {
    SceneOptions options;
    options.threads = threads;
    return std::move(*Scene::create(options));
  }
  Scene scene_;
};

std::vector<Vec3f> places(Scene& scene, InstanceId id) {
  const PosedMesh mesh = scene.mesh(id, 0);
  return {mesh.positions.begin(), mesh.positions.end()};
}

TEST(budget, of_a_new_scene_spreads_the_work_of_many_instances) {
  const auto asset = soft_ball();
  for (const int count : {4, 10}) {
    TornScene torn(asset, 1, count);
    ASSERT_TRUE(torn.scene().update(kFrame));
    EXPECT_EQ(torn.scene().stats().settled_points, 2000u) << count;
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(torn.scene().update(kFrame));
    for (const InstanceId id : torn.ids)
      EXPECT_TRUE(torn.scene().find(id)->particles()->is_settled());
  }
}

TEST(budget, limits_the_points_of_all_instances_together) {
  TornScene torn(soft_ball(), 1);
  std::uint32_t updates = 0, unsettled = 4;
  for (; updates < 3000 && (updates < 3 || unsettled > 0); ++updates) {
    torn.update({.settled_points = 70, .model_work = 1});
    ASSERT_LE(torn.scene().stats().settled_points, 70u);
    ASSERT_LE(torn.scene().stats().model_work, 1u);
    unsettled = torn.scene().stats().unsettled;
  }
  EXPECT_EQ(unsettled, 0u);
  EXPECT_GT(updates, 10u);
  for (const InstanceId id : torn.ids)
    EXPECT_TRUE(torn.scene().find(id)->particles()->is_settled());
}

TEST(budget, nothing_is_settled_without_one) {
  TornScene torn(soft_ball(), 1);
  for (int i = 0; i < 20; ++i) {
    torn.update({.settled_points = 0, .model_work = 0});
    EXPECT_EQ(torn.scene().stats().settled_points, 0u);
  }
  EXPECT_EQ(torn.scene().stats().unsettled, 4u);
}

TEST(budget, recorded_budgets_replay_the_same_bits_on_any_number_of_threads) {
  const auto asset = soft_ball();
  TornScene one(asset, 1), other(asset, 3);
  for (int i = 0; i < 120; ++i) {
    const FrameBudget budget = one.scene().budget_of(20.0 * (i % 7));  // as an engine does it
    one.update(budget);
    other.update(budget);
  }
  for (std::size_t i = 0; i < one.ids.size(); ++i) {
    const auto wanted = places(one.scene(), one.ids[i]),
               found = places(other.scene(), other.ids[i]);
    ASSERT_EQ(wanted.size(), found.size());
    ASSERT_FALSE(wanted.empty());
    EXPECT_EQ(std::memcmp(wanted.data(), found.data(), wanted.size() * sizeof(Vec3f)), 0);
  }
}

TEST(budget, what_was_packed_goes_on_with_the_same_bits) {
  const auto asset = soft_ball();
  TornScene packing(asset, 1, 1), kept(asset, 1, 1);
  const std::uint32_t any = FrameBudget::kUnlimited;
  const auto update = [&](int frames) {
    for (int i = 0; i < frames; ++i) {
      ASSERT_NO_FATAL_FAILURE(packing.update({.settled_points = any, .model_work = any}));
      ASSERT_NO_FATAL_FAILURE(kept.update({.settled_points = any, .model_work = 0}));
    }
  };
  const auto expect_same = [&] {
    const auto wanted = places(kept.scene(), kept.ids[0]),
               found = places(packing.scene(), packing.ids[0]);
    ASSERT_EQ(wanted.size(), found.size());
    EXPECT_EQ(std::memcmp(wanted.data(), found.data(), wanted.size() * sizeof(Vec3f)), 0);
  };
  const auto memory = [](const TornScene& of) {
    return static_cast<double>(of.scene().memory_bytes().instances);
  };
  update(1200);  // its tissue comes to rest
  for (int round = 0; round < 3; ++round) {
    SCOPED_TRACE(round);
    ASSERT_EQ(packing.scene().stats().idle, 1u);
    EXPECT_LT(memory(packing), 0.6 * memory(kept));
    if (round == 1) {
      const auto tissue = [](const TornScene& of) { return *of.scene().find(of.ids[0])->tissue(); };
      EXPECT_TRUE(tissue(packing).particles == tissue(kept).particles);
      EXPECT_TRUE(tissue(packing).body == tissue(kept).body);
      EXPECT_LT(memory(packing), 0.6 * memory(kept)) << "to save it does not unpack it";
    }
    for (TornScene* const of : {&packing, &kept}) {
      if (round == 2) {
        ASSERT_TRUE(of->scene().submit(of->ids[0], UndoCommand{}));
      } else {
        ModelPose pose = std::as_const(*of).scene().find(of->ids[0])->pose();
        pose.model_from_bone[2] = Eigen::Translation3d(0.02, 0, 0.01) * pose.model_from_bone[2];
        ASSERT_TRUE(of->scene().set_pose(of->ids[0], pose));
      }
    }
    for (int i = 0; i < 60; ++i) {
      update(1);
      ASSERT_NO_FATAL_FAILURE(expect_same());
    }
    update(1000);
    expect_same();
  }
}

TEST(budget, no_time_is_no_work) {
  TornScene torn(soft_ball(), 1);
  EXPECT_EQ(torn.scene().budget_of(0).settled_points, 0u);
  EXPECT_EQ(torn.scene().budget_of(0).model_work, 0u);
  EXPECT_GT(torn.scene().budget_of(100).settled_points, 0u);
  EXPECT_EQ(torn.scene().budget_of(-5).settled_points, 0u);
}

}  // namespace
}  // namespace sunder
